#pragma once

#include <vector>

#include "reward/reward_slot.h"
#include "tasks/verification/motion.h"

namespace simwright::tasks {

// The action sequences by which a gripper may achieve the goal of a reward program.
struct ActionSequences {
  // Single actions: joints moved to their limits; objects lifted, carried, placed, pushed, tilted,
  // touched.
  std::vector<std::vector<Action>> single;
  // Sequences of two or three actions: open and fill, fill and close ...
  std::vector<std::vector<Action>> chained;
  // Objects carried out of the arm's reach, and joints moved a third beyond their limits: a success
  // that only these achieve is infeasible.
  std::vector<std::vector<Action>> too_far;
  std::vector<std::vector<Action>> beyond_limits;
};

// Returns action sequences for the objects, links and joints that `slots` name, starting at
// `start`.
ActionSequences SampleActions(const WorldModel& model, const WorldState& start,
                              const std::vector<reward::RewardSlot>& slots);

}  // namespace simwright::tasks
