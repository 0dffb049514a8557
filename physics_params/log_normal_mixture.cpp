#include "physics_params/log_normal_mixture.h"

#include <algorithm>
#include <cmath>

namespace simwright::physics_params {

LogNormal LogNormalOf(const Interval& range, double weight) {
  constexpr double kHalfWidth = 1.6448536269514722;  // deviations of a central 90 %
  constexpr double kLeast = 1e-9;
  const double low = std::log(range.min), high = std::log(range.max);
  return {weight, 0.5 * (low + high), std::max(kLeast, 0.5 * (high - low) / kHalfWidth)};
}

double MixtureQuantile(const std::vector<LogNormal>& mixture, double probability) {
  constexpr double kFar = 9.0;  // deviations
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const LogNormal& one : mixture) {
    low = std::min(low, one.mean - kFar * one.deviation);
    high = std::max(high, one.mean + kFar * one.deviation);
  }
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const LogNormal& one : mixture) {
      below += one.weight * 0.5 * std::erfc((one.mean - middle) / (one.deviation * std::sqrt(2.0)));
    }
    (below < probability ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

Interval CentralInterval(const std::vector<LogNormal>& mixture, double probability) {
  const double tail = 0.5 * (1.0 - probability);
  return {MixtureQuantile(mixture, tail), MixtureQuantile(mixture, 1.0 - tail)};
}

}  // namespace simwright::physics_params
