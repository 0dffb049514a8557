#include "rl/wilson_interval.h"

#include <algorithm>
#include <cmath>

namespace simwright::rl {

Interval WilsonInterval(int successes, int trials, double z) {
  if (trials <= 0) return {};
  const double n = trials, rate = successes / n, square = z * z;
  const double middle = (rate + square / (2.0 * n)) / (1.0 + square / n);
  const double half =
      z / (1.0 + square / n) * std::sqrt(rate * (1.0 - rate) / n + square / (4.0 * n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

}  // namespace simwright::rl
