#include "rl/wilson_interval.h"

#include <gtest/gtest.h>

#include <cmath>

namespace simwright::rl {
namespace {

// Newcombe (1998), "Two-sided confidence intervals for the single proportion", table I, method 3.
TEST(WilsonInterval, AgreesWithPublishedIntervals) {
  const struct {
    int successes, trials;
    double low, high;
  } published[] = {{81, 263, 0.2553, 0.3662},
                   {15, 148, 0.0624, 0.1605},
                   {0, 20, 0.0, 0.1611},
                   {1, 29, 0.0061, 0.1718}};
  for (const auto& row : published) {
    const Interval interval = WilsonInterval(row.successes, row.trials);
    EXPECT_NEAR(interval.low, row.low, 5e-5);
    EXPECT_NEAR(interval.high, row.high, 5e-5);
  }
}

// Its ends p solve |rate - p| = z sqrt(p (1 - p) / n).
TEST(WilsonInterval, ItsEndsSolveTheScoreEquation) {
  constexpr double kZ = 1.959963984540054;
  for (const int trials : {1, 7, 300}) {
    for (int successes = 0; successes <= trials; ++successes) {
      const Interval interval = WilsonInterval(successes, trials);
      const double rate = static_cast<double>(successes) / trials;
      for (const double end : {interval.low, interval.high}) {
        EXPECT_NEAR(std::abs(rate - end), kZ * std::sqrt(end * (1.0 - end) / trials), 1e-7);
      }
    }
  }
  EXPECT_EQ(WilsonInterval(0, 0).low, 0.0);
  EXPECT_EQ(WilsonInterval(0, 0).high, 1.0);
}

}  // namespace
}  // namespace simwright::rl
