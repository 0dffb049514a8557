#pragma once

#include <cstdint>
#include <vector>

namespace simwright::rl {

// What T steps of N environments paid, element t N + i for step t of environment i.
struct RewardSequence {
  int steps = 0;                         // T
  int environments = 0;                  // N
  std::vector<float> rewards;            // (T N)
  std::vector<float> values;             // ((T + 1) N) of what was acted on; last row: what follows
  std::vector<float> last_values;        // (T N) where truncated: of the episode's last observation
  std::vector<std::uint8_t> terminated;  // (T N)
  std::vector<std::uint8_t> truncated;   // (T N)
  std::vector<std::uint8_t> dropped;     // (T N) the step is not to be learnt from
};

struct Advantages {
  std::vector<float> advantages;  // (T N)
  std::vector<float> returns;     // (T N) the critic's targets: advantage + value
};

// Generalised advantage estimation (Schulman et al. 2016, equation 16), `lambda` of 1: the return,
// of 0: one step ahead. Nothing follows a terminated step; what follows a truncated one is worth
// `last_values`, whatever the next episode is worth. The step before a dropped one ends there as if
// truncated; the dropped one itself has advantage 0. A step that is both ended by the task and by
// time is terminated.
Advantages GeneralizedAdvantages(const RewardSequence& sequence, double discount, double lambda);

}  // namespace simwright::rl
