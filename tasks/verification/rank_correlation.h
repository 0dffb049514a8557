#pragma once

#include <span>

namespace simwright::tasks {

// Returns Spearman's rank correlation of two series of equal length, in [-1, 1]: Pearson's
// correlation of their ranks, where ties share their mean rank. Returns 0 if a series is constant
// or shorter than 2. Values within `tie` (>= 0) of their predecessor in sorted order count as
// equal.
double RankCorrelation(std::span<const double> a, std::span<const double> b, double tie = 0.0);

}  // namespace simwright::tasks
