#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rl/vector_environment.h"

namespace simwright::rl {

// T steps of N environments as PPO learns from them: row t N + i for step t of environment i.
// Observations are normalised, rewards scaled.
struct Rollout {
  int steps = 0;           // T
  int environments = 0;    // N
  Rows observations;       // (T N x O)
  Rows actions, means;     // (T N x A) as drawn, and the mean that they were drawn about
  Rows shown;              // (T N x A) demonstrated there; empty where nothing is imitated
  Eigen::RowVectorXf std;  // (A) of the policy that acted
  std::vector<float> log_densities;                          // (T N)
  std::vector<float> rewards;                                // (T N)
  std::vector<std::uint8_t> terminated, truncated, dropped;  // (T N)
  Rows next_observations;                                    // (N x O) what follows the last step
  Rows last_observations;              // (K x O) before the reset, of each truncated step
  std::vector<std::size_t> last_rows;  // (K) which step that is

  // Makes room for T steps of N environments, and forgets what was there.
  void Resize(int steps, int environments, int observation_size, int action_size);
};

}  // namespace simwright::rl
