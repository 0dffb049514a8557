#pragma once

#include <span>

namespace simwright::tasks {

// Spearman's rank correlation of two series of one length, in [-1, 1]: Pearson's correlation of
// their ranks, ties sharing the mean of theirs. 0 where one of them is constant, or shorter than 2.
// Values closer than `tie` (>= 0) to the one before them in order count as equal.
double RankCorrelation(std::span<const double> a, std::span<const double> b, double tie = 0.0);

}  // namespace simwright::tasks
