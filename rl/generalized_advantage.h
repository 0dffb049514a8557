#pragma once

#include <cstdint>
#include <vector>

namespace simwright::rl {

// The rewards and values of T steps of N environments, element t N + i for step t of environment i.
struct RewardSequence {
  int steps = 0;                         // T
  int environments = 0;                  // N
  std::vector<float> rewards;            // (T N)
  std::vector<float> values;             // ((T + 1) N) last row: after the last step
  std::vector<float> last_values;        // (T N) where truncated: of the episode's last observation
  std::vector<std::uint8_t> terminated;  // (T N)
  std::vector<std::uint8_t> truncated;   // (T N)
  std::vector<std::uint8_t> dropped;     // (T N) the step is excluded from learning
};

struct Advantages {
  std::vector<float> advantages;  // (T N)
  std::vector<float> returns;     // (T N) the critic's targets: advantage + value
};

// Returns the generalized advantage estimates (Schulman et al. 2016, equation 16). `lambda` 1 gives
// the Monte Carlo return, 0 the one-step estimate. A terminated step has no successor value; a
// truncated one bootstraps from `last_values`, not from the next episode. The step before a dropped
// one ends there as if truncated; the dropped one itself has advantage 0. A step that is both
// terminated and truncated counts as terminated.
Advantages GeneralizedAdvantages(const RewardSequence& sequence, double discount, double lambda);

}  // namespace simwright::rl
