#include "physics_params/interval_score.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

// Returns the probability of at most `most` successes of `trials` at `rate`, 0 < rate < 1.
double BinomialAtMost(int most, int trials, double rate) {
  double sum = 0.0;
  for (int k = 0; k <= most; ++k) {
    sum +=
        std::exp(std::lgamma(trials + 1.0) - std::lgamma(k + 1.0) - std::lgamma(trials - k + 1.0) +
                 k * std::log(rate) + (trials - k) * std::log1p(-rate));
  }
  return sum;
}

// Returns the rate at which the probability of at most `most` successes is `tail`.
double RateAtTail(int most, int trials, double tail) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (BinomialAtMost(most, trials, middle) > tail ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Interval BinomialRange(int successes, int trials) {
  constexpr double kTail = 0.025;
  return {successes == 0 ? 0.0 : RateAtTail(successes - 1, trials, 1.0 - kTail),
          successes == trials ? 1.0 : RateAtTail(successes, trials, kTail)};
}

IntervalScores ScoreIntervals(const std::vector<ScoredInterval>& intervals, double probability) {
  if (intervals.empty()) throw core::Error("there is no interval to score");
  if (!(probability > 0.0 && probability < 1.0)) {
    throw core::Error("a stated probability must lie between 0 and 1");
  }
  IntervalScores scores;
  std::vector<double> factors;
  for (const ScoredInterval& one : intervals) {
    const Interval& range = one.stated;
    if (!(range.min > 0.0 && range.min <= range.max && one.truth > 0.0)) {
      throw core::Error("an interval and its truth must be positive and ascending");
    }
    const double miss =
        std::max({0.0, std::log(range.min / one.truth), std::log(one.truth / range.max)});
    scores.mean_score += std::log(range.max / range.min) + 2.0 / (1.0 - probability) * miss;
    scores.covered += range.Contains(one.truth) ? 1 : 0;
    factors.push_back(range.max / range.min);
  }
  scores.count = static_cast<int>(intervals.size());
  scores.coverage = static_cast<double>(scores.covered) / scores.count;
  scores.coverage_range = BinomialRange(scores.covered, scores.count);
  scores.mean_score /= scores.count;
  const auto middle = factors.begin() + static_cast<std::ptrdiff_t>(factors.size() / 2);
  std::nth_element(factors.begin(), middle, factors.end());
  scores.median_factor = *middle;
  return scores;
}

double ConformalQuantile(std::vector<double> scores, double probability) {
  const size_t rank = static_cast<size_t>(
      std::ceil((static_cast<double>(scores.size()) + 1.0) * probability - 1e-9));
  if (rank < 1 || rank > scores.size()) {
    throw core::Error("too few objects for the stated probability",
                      std::to_string(scores.size()) + " objects");
  }
  std::nth_element(scores.begin(), scores.begin() + static_cast<std::ptrdiff_t>(rank - 1),
                   scores.end());
  return scores[rank - 1];
}

}  // namespace simwright::physics_params
