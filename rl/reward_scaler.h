#pragma once

#include <cstdint>
#include <vector>

#include "rl/running_moments.h"

namespace simwright::rl {

// Divides rewards by the running standard deviation of the discounted return, so that the critic's
// targets are of size 1 for any reward program (Engstrom et al. 2020, "Implementation Matters in
// Deep Policy Gradients"). The mean is kept: shifting rewards would change the task.
class RewardScaler {
 public:
  // The clipping limit of scaled rewards.
  static constexpr float kLimit = 10.0f;

  RewardScaler(int environments, double discount);

  // Scales the rewards (N) of a step in place. `ended`: an episode's last step; `dropped`:
  // excluded.
  void Scale(const std::vector<std::uint8_t>& ended, const std::vector<std::uint8_t>& dropped,
             std::vector<float>* rewards);

  // The state of the scaler.
  const RunningMoments& moments() const { return moments_; }
  const std::vector<double>& discounted_returns() const { return discounted_returns_; }
  void Restore(const RunningMoments& moments, const std::vector<double>& discounted_returns);

 private:
  double discount_;
  RunningMoments moments_{1};
  std::vector<double> discounted_returns_;  // (N) of each environment's episode so far
};

}  // namespace simwright::rl
