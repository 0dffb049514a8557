#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/random.h"
#include "reward/reward_slot.h"
#include "tasks/verification/title_direction.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

// Returns a start state for a program that specifies none: the objects that it reads, and those of
// `assets`, in front of the robot. Joints that it reads are at rest, or at their far limit if the
// title asks to move them back to rest. An object that the title takes out of another starts inside
// it ("take the cup out of the microwave"). Returns nullopt if no placement is found.
std::optional<InitialState> PlanStart(const WorldModel& model,
                                      const std::vector<reward::RewardSlot>& slots,
                                      const std::vector<std::string>& assets,
                                      const std::string& title, TitleDirection direction,
                                      core::Rng& rng);

// Returns a goal for programs that need one: a reachable point beside and above the first object
// that can be carried, else the position of a handle at the far limit of its joint.
Eigen::Vector3d PlanGoal(const WorldModel& model, const WorldState& start,
                         const std::vector<reward::RewardSlot>& slots);

// Returns `state` as the start of the next subtask: objects, joints and the held object.
InitialState StartOfNextSubtask(const WorldModel& model, const WorldState& state,
                                const InitialState& before);

}  // namespace simwright::tasks
