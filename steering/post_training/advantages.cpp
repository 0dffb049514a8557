#include "steering/post_training/advantages.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::steering {

std::vector<double> Advantages(const std::vector<double>& rewards, int groups) {
  if (groups < 1) throw core::Error("advantages need at least one group");
  for (const double reward : rewards) {
    if (!std::isfinite(reward)) throw core::Error("a reward is not a finite number");
  }
  std::vector<double> advantages(rewards.size(), 0.0);
  const auto step = static_cast<size_t>(groups);
  for (size_t group = 0; group < step; ++group) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (size_t i = group; i < rewards.size(); i += step) {
      sum += rewards[i];
      count += 1.0;
    }
    const double mean = count > 0.0 ? sum / count : 0.0;
    for (size_t i = group; i < rewards.size(); i += step) {
      squares += (rewards[i] - mean) * (rewards[i] - mean);
    }
    const double deviation = count > 0.0 ? std::sqrt(squares / count) : 0.0;
    // Rewards that differ by rounding only are equal.
    if (deviation <= 1e-9 * std::max(1.0, std::abs(mean))) continue;
    for (size_t i = group; i < rewards.size(); i += step) {
      advantages[i] =
          std::clamp((rewards[i] - mean) / deviation, -kLargestAdvantage, kLargestAdvantage);
    }
  }
  return advantages;
}

}  // namespace simwright::steering
