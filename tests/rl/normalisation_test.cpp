// Running moments against the moments of all rows at once.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random.h"
#include "rl/observation_normalizer.h"
#include "rl/reward_scaler.h"

namespace simwright::rl {
namespace {

Rows RandomRows(int rows, int columns) {
  core::Rng rng(5);
  Rows result(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      result(i, j) = static_cast<float>(1000.0 * static_cast<double>(j) +
                                        (0.1 + static_cast<double>(j)) * core::Normal(rng));
    }
  }
  return result;
}

TEST(RunningMoments, MergedBatchesGiveTheMomentsOfAllRows) {
  const Rows rows = RandomRows(997, 4);
  RunningMoments merged(4);
  for (Eigen::Index first = 0, size = 1; first < 997; first += size, size = 2 * size + 1) {
    merged.Add(rows.middleRows(first, std::min<Eigen::Index>(size, 997 - first)));
  }
  EXPECT_EQ(merged.count, 997.0);
  const Eigen::ArrayXXd all = rows.cast<double>().array();
  const Eigen::ArrayXd mean = all.colwise().mean();
  const Eigen::ArrayXd variance =
      (all.rowwise() - mean.transpose()).square().colwise().mean().transpose();
  EXPECT_LT((merged.mean - mean).abs().maxCoeff(), 1e-9);
  EXPECT_LT((merged.Variance() / variance - 1.0).abs().maxCoeff(), 1e-9);
}

TEST(RunningMoments, ARowThatIsNotFiniteIsLeftOut) {
  Rows rows = RandomRows(50, 2);
  RunningMoments clean(2), spoilt(2);
  clean.Add(rows);
  Rows more(52, 2);
  more << rows, std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f,
      std::numeric_limits<float>::infinity();
  spoilt.Add(more);
  EXPECT_EQ(spoilt.count, 50.0);
  EXPECT_LT((spoilt.mean - clean.mean).abs().maxCoeff(), 1e-12);
}

TEST(ObservationNormalizer, ScalesToUnitVarianceClipsAndIsFrozenByCopying) {
  const Rows rows = RandomRows(2000, 3);
  ObservationNormalizer normalizer(3);
  normalizer.Update(rows);
  Rows scaled;
  normalizer.Apply(rows, &scaled);
  EXPECT_LT(scaled.colwise().mean().cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_NEAR(scaled.squaredNorm() / 6000.0f, 1.0f, 2e-3);

  const ObservationScale frozen = normalizer.scale();
  normalizer.Update(RandomRows(10, 3) * 2.0f);
  Rows odd(2, 3);
  odd << 1e9f, std::numeric_limits<float>::quiet_NaN(), -1e9f, 0.0f, 1000.0f, 2000.0f;
  frozen.Apply(odd, &odd);
  EXPECT_EQ(odd(0, 0), 10.0f);
  EXPECT_EQ(odd(0, 1), 0.0f);
  EXPECT_EQ(odd(0, 2), -10.0f);
  Rows again;
  frozen.Apply(rows, &again);
  EXPECT_EQ((again - scaled).cwiseAbs().maxCoeff(), 0.0f);
  normalizer.Apply(rows, &again);
  EXPECT_GT((again - scaled).cwiseAbs().maxCoeff(), 0.01f);
}

// Rewards of 3 +- 0 in episodes without end: the discounted return tends to 3 / (1 - discount).
// With random rewards its standard deviation is that of a sum of independent terms, s / sqrt(1 -
// discount^2).
TEST(RewardScaler, DividesByTheStandardDeviationOfTheReturn) {
  constexpr int kCount = 200;
  constexpr double kDiscount = 0.9, kSpread = 7.0;
  RewardScaler scaler(kCount, kDiscount);
  const std::vector<std::uint8_t> none(kCount, 0);
  core::Rng rng(1);
  std::vector<float> raw(kCount), scaled;
  for (int step = 0; step < 400; ++step) {
    for (float& reward : raw) reward = static_cast<float>(kSpread * core::Normal(rng));
    scaled = raw;
    scaler.Scale(none, none, &scaled);
  }
  const double expected = kSpread / std::sqrt(1.0 - kDiscount * kDiscount);
  EXPECT_NEAR(raw[0] / scaled[0], expected, 0.02 * expected);
}

TEST(RewardScaler, AnEndedEpisodeIsForgottenAndADroppedRewardIsNotCounted) {
  RewardScaler scaler(2, 0.5);
  std::vector<float> rewards = {2.0f, std::nanf("")};
  scaler.Scale({0, 0}, {0, 1}, &rewards);
  EXPECT_EQ(scaler.discounted_returns()[0], 2.0);
  EXPECT_EQ(scaler.moments().count, 1.0);
  EXPECT_EQ(rewards[1], 0.0f);
  rewards = {2.0f, 1.0f};
  scaler.Scale({1, 0}, {0, 0}, &rewards);
  EXPECT_EQ(scaler.discounted_returns()[0], 0.0);
  EXPECT_EQ(scaler.discounted_returns()[1], 1.0);
}

}  // namespace
}  // namespace simwright::rl
