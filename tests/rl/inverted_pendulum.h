#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/random.h"
#include "rl/vector_environment.h"
#include "sim/articulated_world.h"

namespace simwright::rl {

// A pole on a cart on a rail in Bullet, after Gymnasium's InvertedPendulum-v4: a 10.47 kg cart, a
// 5.02 kg pole of 0.6 m, joint damping 1, +-300 N on the cart, two steps of 0.02 s per action, a
// reward of 1 per step, termination if the pole leans more than 0.2 rad, 1000 steps at most.
// Observations: positions and velocities of cart and pole. Starts within +-0.01 m and rad at rest
// (the original with velocities of that size too). Its state cannot be saved.
class InvertedPendulum : public VectorEnvironment {
 public:
  static constexpr int kLongest = 1000;

  explicit InvertedPendulum(int count);

  int size() const override { return static_cast<int>(carts_.size()); }
  int observation_size() const override { return 4; }
  int action_size() const override { return 1; }
  void Reset(std::uint64_t seed, Rows* observations) override;
  void Step(const Rows& actions, StepBatch* batch) override;
  std::string SaveState() const override;
  void RestoreState(std::string_view state, Rows* observations) override;

 private:
  struct Cart {
    std::unique_ptr<sim::ArticulatedWorld> world;
    core::Rng rng;
    int steps = 0;
  };
  void Start(Cart* cart) const;
  Eigen::RowVectorXf Observe(const Cart& cart) const;

  sim::ArticulatedBody body_;
  std::vector<Cart> carts_;
};

// Returns the mean number of steps, of at most InvertedPendulum::kLongest, for which `act`, which
// writes actions (count x 1) for observations (count x 4), keeps the pole upright: over the first
// episode of each of `count` environments.
double MeanStepsUpright(int count, std::uint64_t seed,
                        const std::function<void(const Rows& observations, Rows* actions)>& act);

}  // namespace simwright::rl
