#include "transfer/transfer_rate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simwright::transfer {
namespace {

// World i of 100 succeeds up to the scale `strength` * (i + 1) / 100.
WorldTrial Spread(double strength) {
  return [strength](double scale, std::uint64_t index) {
    return scale <= strength * (static_cast<double>(index) + 1.0) / 100.0;
  };
}

double ScaleOf(const WorldTrial& trial, double share) {
  return LargestScale(trial, RateAt(trial, 1.0, 100), share);
}

TEST(RateAt, CountsSuccessesWithWilsonsInterval) {
  const TransferRate rate = RateAt(Spread(2.0), 1.0, 100);
  EXPECT_EQ(rate.worlds, 100);
  EXPECT_EQ(rate.successes, 51);  // strength (i + 1) / 100 >= 1 from i = 49 on
  EXPECT_NEAR(rate.interval.low, 0.4135, 5e-4);
  EXPECT_NEAR(rate.interval.high, 0.6058, 5e-4);
}

TEST(LargestScale, FindsWhereTheRateFallsBelowTheShare) {
  // 90 of 100 worlds succeed up to strength * 0.11.
  EXPECT_NEAR(ScaleOf(Spread(5.0), 0.9), 0.55, 1.0 / 16.0);
  EXPECT_NEAR(ScaleOf(Spread(15.0), 0.9), 1.65, 1.65 / 16.0);
  EXPECT_NEAR(ScaleOf(Spread(15.0), 0.5), 4.0, 1e-9);  // 7.65: as far as it is searched
  EXPECT_LE(ScaleOf(Spread(5.0), 0.9), 0.55);          // it holds there
}

TEST(LargestScale, IsNegativeForWhatFailsWithoutUncertainty) {
  EXPECT_EQ(ScaleOf([](double, std::uint64_t index) { return index >= 20; }, 0.9), -1.0);
}

}  // namespace
}  // namespace simwright::transfer
