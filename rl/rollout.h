#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rl/vector_environment.h"

namespace simwright::rl {

// T steps of N environments for PPO: row t N + i for step t of environment i. Observations are
// normalized, rewards scaled.
struct Rollout {
  int steps = 0;                     // T
  int environments = 0;              // N
  Rows observations;                 // (T N x O)
  Rows actions, means;               // (T N x A) sampled actions, and their means
  Rows shown;                        // (T N x A) demonstrated actions; empty without imitation
  Eigen::RowVectorXf std;            // (A) of the policy that acted
  std::vector<float> log_densities;  // (T N)
  std::vector<float> rewards;        // (T N)
  std::vector<std::uint8_t> terminated, truncated, dropped;  // (T N)
  Rows next_observations;                                    // (N x O) after the last step
  Rows last_observations;              // (K x O) before the reset, of each truncated step
  std::vector<std::size_t> last_rows;  // (K) the row of each

  // Resizes for T steps of N environments and discards previous data.
  void Resize(int steps, int environments, int observation_size, int action_size);
};

}  // namespace simwright::rl
