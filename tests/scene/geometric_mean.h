#pragma once

#include <cmath>

namespace simwright::scene {

// The mean of k = 0 .. last with P(k) ~ (1 - p)^k p.
inline double MeanOfGeometric(double p, int last) {
  double sum = 0.0, total = 0.0;
  for (int k = 0; k <= last; ++k) {
    sum += k * std::pow(1.0 - p, k);
    total += std::pow(1.0 - p, k);
  }
  return sum / total;
}

}  // namespace simwright::scene
