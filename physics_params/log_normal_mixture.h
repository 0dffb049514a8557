#pragma once

#include <vector>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// A weighted normal distribution of a natural logarithm.
struct LogNormal {
  double weight = 0.0;
  double mean = 0.0;       // of the logarithm
  double deviation = 0.0;  // standard deviation of the logarithm, > 0
};

// Returns the distribution whose central 90 % is `range`; of one value, a deviation of 1e-9.
LogNormal LogNormalOf(const Interval& range, double weight);

// Returns the value below which the mixture has the share `probability`, 0 < probability < 1; the
// weights sum to 1. Bisection to 1e-12 of the logarithm's range.
double MixtureQuantile(const std::vector<LogNormal>& mixture, double probability);

// Returns the central interval of the mixture with the given probability.
Interval CentralInterval(const std::vector<LogNormal>& mixture, double probability);

}  // namespace simwright::physics_params
