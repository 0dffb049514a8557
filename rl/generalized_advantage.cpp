#include "rl/generalized_advantage.h"

namespace simwright::rl {

Advantages GeneralizedAdvantages(const RewardSequence& sequence, double discount, double lambda) {
  const auto count = static_cast<std::size_t>(sequence.environments);
  const std::size_t all = static_cast<std::size_t>(sequence.steps) * count;
  Advantages result{std::vector<float>(all), std::vector<float>(all)};
  std::vector<double> following(count, 0.0);  // the advantage one step later
  for (std::size_t k = all; k-- > 0;) {
    const std::size_t i = k % count;
    const double value = sequence.values[k];
    if (sequence.dropped[k]) {
      following[i] = 0.0;
    } else {
      double next_value = sequence.values[k + count];
      if (sequence.truncated[k]) next_value = sequence.last_values[k];
      if (sequence.terminated[k]) next_value = 0.0;
      const bool ended = sequence.terminated[k] || sequence.truncated[k];
      const double error = sequence.rewards[k] + discount * next_value - value;
      following[i] = error + (ended ? 0.0 : discount * lambda * following[i]);
    }
    result.advantages[k] = static_cast<float>(following[i]);
    result.returns[k] = static_cast<float>(following[i] + value);
  }
  return result;
}

}  // namespace simwright::rl
