#pragma once

#include <vector>

#include "tasks/reward/reward_slot.h"
#include "tasks/verification/motion.h"

namespace simwright::tasks {

// Ways in which a hand might bring about what a reward program looks at.
struct ActionSequences {
  // One action each: joints to their ends, things lifted, carried, placed, pushed, tilted, touched.
  std::vector<std::vector<Action>> single;
  // Two or three one after the other: opened and filled, filled and closed ...
  std::vector<std::vector<Action>> chained;
  // Things carried to where no arm reaches, and joints moved a third beyond their ends: what only
  // these bring about cannot be done.
  std::vector<std::vector<Action>> too_far;
  std::vector<std::vector<Action>> beyond_limits;
};

// For the things, links and joints that `slots` name, from `start` on.
ActionSequences SampleActions(const SceneModel& model, const SceneState& start,
                              const std::vector<RewardSlot>& slots);

}  // namespace simwright::tasks
