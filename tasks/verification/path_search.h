#pragma once

#include <optional>
#include <vector>

#include "reward/reward_program.h"
#include "tasks/verification/motion.h"

namespace simwright::tasks {

// A path to success and the behaviour of the reward along it.
struct SuccessPath {
  Motion motion;
  std::size_t first = 0;   // index of the first state in which success holds
  bool reachable = false;  // the arm can reach every state
  // The rank correlation of reward and progress up to `first`. It is computed over the whole path
  // and over each segment (approach, move, turn over, between two steps of the reward); the value
  // is the minimum over those in which the reward changes.
  double agreement = 0.0;
};

// The range of rewards and success flags seen during the search.
struct RewardRange {
  double lowest = 0.0, highest = 0.0;
  bool any = false, finite = true;
  bool always_success = true, ever_success = false;

  void Add(float reward, bool success);
};

// Returns the best path to success among `sequences`: reachable paths come before unreachable ones,
// then the agreement decides. If `stop_early`, returns at the first good enough path. Every
// evaluated state is added to `range` unless it is null.
std::optional<SuccessPath> FindSuccessPath(const reward::RewardProgram& program,
                                           const WorldModel& model, const WorldState& start,
                                           const Eigen::Isometry3d& world_from_robot,
                                           const std::vector<std::vector<Action>>& sequences,
                                           bool stop_early, RewardRange* range);

}  // namespace simwright::tasks
