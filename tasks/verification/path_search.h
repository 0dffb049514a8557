#pragma once

#include <optional>
#include <vector>

#include "tasks/reward/reward_program.h"
#include "tasks/verification/motion.h"

namespace simwright::tasks {

// A way to success, and how the reward goes along it.
struct SuccessPath {
  Motion motion;
  std::size_t first = 0;   // the first state in which success holds
  bool reachable = false;  // by the arm, all along
  // Rank correlation of reward and progress up to `first`: over the whole way, and over each part
  // (the hand comes; moves; turns over; between two steps of the reward); the least of those in
  // which the reward changes.
  double agreement = 0.0;
};

// What was seen while searching.
struct RewardRange {
  double lowest = 0.0, highest = 0.0;
  bool any = false, finite = true;
  bool always_success = true, ever_success = false;

  void Add(float reward, bool success);
};

// The best way to success among `sequences`: one within reach before one that is not, then by its
// agreement. Stops early at one that is good enough. `range` (may be null) takes in every state.
std::optional<SuccessPath> FindSuccessPath(const RewardProgram& program, const SceneModel& model,
                                           const SceneState& start,
                                           const Eigen::Isometry3d& world_from_robot,
                                           const std::vector<std::vector<Action>>& sequences,
                                           bool stop_early, RewardRange* range);

}  // namespace simwright::tasks
