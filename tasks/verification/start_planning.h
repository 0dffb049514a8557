#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "tasks/reward/reward_slot.h"
#include "tasks/scene_state.h"
#include "tasks/verification/title_direction.h"

namespace simwright::tasks {

// Where an episode of a program may start that says nothing of it: the things that it looks at, and
// those of `assets`, in front of the robot. Joints that it looks at stand at rest, or, where the
// title says that they shall go back there, at their far end; a thing that is to come out of
// another stands inside it ("take the cup out of the microwave"). Empty where there is no place.
std::optional<InitialState> PlanStart(const SceneModel& model, const std::vector<RewardSlot>& slots,
                                      const std::vector<std::string>& assets,
                                      const std::string& title, TitleDirection direction,
                                      core::Rng& rng);

// A goal for programs that ask for one: within reach, beside and above the first thing that can be
// carried; else a handle's place at the far end of its joint.
Eigen::Vector3d PlanGoal(const SceneModel& model, const SceneState& start,
                         const std::vector<RewardSlot>& slots);

// `state` as the start of what follows: things, joints and what the hand holds.
InitialState StartFrom(const SceneModel& model, const SceneState& state,
                       const InitialState& before);

}  // namespace simwright::tasks
