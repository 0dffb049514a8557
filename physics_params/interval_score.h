#pragma once

#include <vector>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// A stated interval and the value that was measured; all are positive.
struct ScoredInterval {
  Interval stated;
  double truth = 0.0;
};

struct IntervalScores {
  int count = 0;
  int covered = 0;
  double coverage = 0.0;    // covered / count
  Interval coverage_range;  // exact binomial 95 % interval of the coverage (Clopper, Pearson 1934)
  double mean_score = 0.0;  // interval score of the logarithms: small is good
  double median_factor = 1.0;  // max / min of the stated intervals
};

// Scores intervals that are stated to hold with `probability` = 1 - a. The interval score is that
// of T. Gneiting and A. Raftery, "Strictly proper scoring rules, prediction, and estimation", 2007,
// eq. 43, on logarithms: ln(u / l) + 2/a ln(l / y) if y < l, + 2/a ln(y / u) if y > u. It cannot be
// improved by wider intervals. Throws core::Error unless there is an interval, all values are
// positive, and 0 < probability < 1.
IntervalScores ScoreIntervals(const std::vector<ScoredInterval>& intervals, double probability);

// Returns the exact binomial 95 % interval of a rate, given `successes` of `trials` > 0.
Interval BinomialRange(int successes, int trials);

// Returns the split-conformal quantile: the ceil((n + 1) probability)-th smallest of n scores, the
// inflation at which a new exchangeable object is covered with at least `probability` (Vovk et al.,
// "Algorithmic Learning in a Random World", 2005). Throws core::Error if n is too small for it.
double ConformalQuantile(std::vector<double> scores, double probability);

}  // namespace simwright::physics_params
