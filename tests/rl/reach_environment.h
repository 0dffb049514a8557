#pragma once

#include <vector>

#include "core/random.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// Points on a line to be driven to 0: x' = x + h v, v' = v + h u, u = kPush times the action. A
// step costs x^2 + kSpeedCost v^2 + kPushCost u^2: linear dynamics and quadratic costs, so that the
// optimal policy is known (Riccati). An episode ends by time after `episode_steps`, with success if
// |x| < 0.05 at its end; it terminates for |x| > 3, at a cost of kLeavingCost: more than the return
// would have cost.
class ReachEnvironment : public VectorEnvironment {
 public:
  static constexpr double kTimeStep = 0.1, kPush = 3.0, kSpeedCost = 0.1, kPushCost = 0.02;
  static constexpr double kLeavingCost = 100.0;

  explicit ReachEnvironment(int count, int episode_steps = 60);

  int size() const override { return static_cast<int>(points_.size()); }
  int observation_size() const override { return 2; }  // x, v
  int action_size() const override { return 1; }
  void Reset(std::uint64_t seed, Rows* observations) override;
  void Step(const Rows& actions, StepBatch* batch) override;
  std::string SaveState() const override;
  void RestoreState(std::string_view state, Rows* observations) override;

  // Makes the next reward of environment `i` NaN.
  void Spoil(int i) { spoilt_ = i; }

 private:
  struct Point {
    double x = 0.0, v = 0.0;
    int steps = 0;
  };
  Point SampleStart();
  void Observe(Rows* observations) const;

  int episode_steps_;
  int spoilt_ = -1;
  core::Rng rng_;
  std::vector<Point> points_;
};

}  // namespace simwright::rl
