#include "physics_params/interval_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"

namespace simwright::physics_params {
namespace {

// Gneiting and Raftery's eq. 43 by hand: width, and 2/a = 20 times the miss.
TEST(IntervalScore, IsWidthPlusTwentyTimesTheMiss) {
  const IntervalScores inside = ScoreIntervals({{{1.0, std::exp(1.0)}, 2.0}}, 0.9);
  EXPECT_NEAR(inside.mean_score, 1.0, 1e-12);
  EXPECT_EQ(inside.covered, 1);
  const IntervalScores below = ScoreIntervals({{{1.0, std::exp(1.0)}, std::exp(-0.5)}}, 0.9);
  EXPECT_NEAR(below.mean_score, 1.0 + 20.0 * 0.5, 1e-9);
  const IntervalScores above = ScoreIntervals({{{1.0, std::exp(1.0)}, std::exp(1.25)}}, 0.9);
  EXPECT_NEAR(above.mean_score, 1.0 + 20.0 * 0.25, 1e-9);
  EXPECT_EQ(above.covered, 0);
  EXPECT_THROW(ScoreIntervals({}, 0.9), core::Error);
  EXPECT_THROW(ScoreIntervals({{{0.0, 1.0}, 1.0}}, 0.9), core::Error);
  EXPECT_THROW(ScoreIntervals({{{1.0, 2.0}, 1.0}}, 1.0), core::Error);
}

// Clopper and Pearson: 0 of n ends at 1 - 0.025^(1/n), n of n starts at 0.025^(1/n); 45 of 50 from
// the published tables.
TEST(IntervalScore, BinomialRangeAgreesWithTheTables) {
  EXPECT_NEAR(BinomialRange(0, 20).max, 1.0 - std::pow(0.025, 1.0 / 20), 1e-9);
  EXPECT_NEAR(BinomialRange(20, 20).min, std::pow(0.025, 1.0 / 20), 1e-9);
  EXPECT_EQ(BinomialRange(20, 20).max, 1.0);
  EXPECT_NEAR(BinomialRange(45, 50).min, 0.7819, 1e-4);
  EXPECT_NEAR(BinomialRange(45, 50).max, 0.9667, 1e-4);
}

TEST(IntervalScore, ConformalQuantileIsTheRankedScore) {
  EXPECT_EQ(ConformalQuantile({5, 1, 4, 2, 3, 6, 7, 8, 9}, 0.9), 9.0);  // ceil(10 * 0.9)
  EXPECT_EQ(ConformalQuantile({5, 1, 4, 2, 3, 6, 7, 8, 9}, 0.5), 5.0);  // ceil(10 * 0.5)
  EXPECT_THROW(ConformalQuantile({1, 2, 3}, 0.9), core::Error);         // ceil(4 * 0.9) > 3
}

// The guarantee of split conformal prediction: of new values of the same distribution, at least the
// stated share is covered on average, and at most 1 / (n + 1) more.
TEST(IntervalScore, ConformalQuantileCoversNewDraws) {
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  constexpr int kRounds = 4000, kSize = 39;
  int covered = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> scores(kSize);
    for (double& score : scores) score = normal(engine);
    covered += normal(engine) <= ConformalQuantile(scores, 0.9) ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(covered) / kRounds, 0.9, 0.02);
}

}  // namespace
}  // namespace simwright::physics_params
