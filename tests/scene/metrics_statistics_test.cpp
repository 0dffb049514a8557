// Metrics with known answers: frequencies, Gaussians, separable and identical classes.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "scene/metrics/asset_frequency.h"
#include "scene/metrics/classifier_accuracy.h"
#include "scene/metrics/frechet.h"

namespace simwright::scene {
namespace {

FeatureMatrix NormalRows(int rows, int size, std::uint64_t seed) {
  core::Rng rng = core::StreamRng(seed, 0);
  FeatureMatrix features(rows, size);
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < size; ++k) features(i, k) = static_cast<float>(core::Normal(rng));
  }
  return features;
}

// A rotation times a diagonal times its transpose.
Eigen::MatrixXd Turned(const Eigen::VectorXd& diagonal) {
  const Eigen::MatrixXd random =
      NormalRows(static_cast<int>(diagonal.size()), static_cast<int>(diagonal.size()), 5)
          .cast<double>();
  const Eigen::MatrixXd turn = Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ();
  return turn * diagonal.asDiagonal() * turn.transpose();
}

TEST(Frechet, IsTheClosedFormOfGaussians) {
  // Covariances of the same axes: |m - n|^2 + sum (sqrt s - sqrt t)^2.
  Gaussian a, b;
  a.mean = Eigen::Vector4d(1, 2, 3, 4);
  b.mean = Eigen::Vector4d(1, 2, 0, 8);
  a.covariance = Turned(Eigen::Vector4d(4, 9, 1, 0));
  b.covariance = Turned(Eigen::Vector4d(1, 16, 1, 25));
  const double expected = 25.0 + 1.0 + 1.0 + 0.0 + 25.0;
  EXPECT_NEAR(FrechetDistance(a, b), expected, 1e-6);
  EXPECT_NEAR(FrechetDistance(b, a), expected, 1e-6);
  EXPECT_NEAR(FrechetDistance(a, a), 0.0, 1e-6);
}

TEST(Frechet, IsTheClosedFormOfAxesThatDiffer) {
  // In two dimensions tr (S^1/2 T S^1/2)^1/2 = sqrt(tr(S T) + 2 sqrt(det S det T)).
  Gaussian a, b;
  a.mean = b.mean = Eigen::Vector2d::Zero();
  a.covariance = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  b.covariance = Eigen::Matrix2d{{3.0, 1.5}, {1.5, 2.0}};
  const double root =
      std::sqrt((a.covariance * b.covariance).trace() +
                2.0 * std::sqrt(a.covariance.determinant() * b.covariance.determinant()));
  EXPECT_NEAR(FrechetDistance(a, b), 5.0 + 5.0 - 2.0 * root, 1e-9);
}

TEST(Frechet, OfFeaturesThatAreShifted) {
  const FeatureMatrix features = NormalRows(500, 6, 1);
  FeatureMatrix shifted = 2.0f * features;
  shifted.col(3).array() += 3.0f;
  const Gaussian one = GaussianOf(features), other = GaussianOf(shifted);
  // Twice as wide about twice the mean: (2 - 1)^2 of each variance.
  const double expected = (other.mean - one.mean).squaredNorm() + one.covariance.trace();
  EXPECT_NEAR(FrechetDistance(one, other), expected, 1e-4);
  EXPECT_NEAR(FrechetDistance(one, GaussianOf(features)), 0.0, 1e-9);
  EXPECT_NEAR(one.covariance.trace(), 6.0, 0.6);
}

TEST(Frechet, RefusesWhatIsNone) {
  EXPECT_THROW(GaussianOf(NormalRows(1, 3, 1)), core::Error);
  FeatureMatrix broken = NormalRows(5, 3, 1);
  broken(2, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(GaussianOf(broken), core::Error);
  EXPECT_THROW(FrechetDistance(GaussianOf(NormalRows(5, 3, 1)), GaussianOf(NormalRows(5, 4, 1))),
               core::Error);
}

TEST(FrequencyDivergence, IsKnown) {
  EXPECT_DOUBLE_EQ(FrequencyDivergence({10, 0, 5}, {10, 0, 5}), 0.0);
  // Shares of (1.5, 0.5) / 2 and (0.5, 1.5) / 2: 0.5 log 3.
  EXPECT_NEAR(FrequencyDivergence({1, 0}, {0, 1}), 0.5 * std::log(3.0), 1e-12);
  // Many objects: the pseudo-counts are negligible.
  EXPECT_NEAR(FrequencyDivergence({750000, 250000}, {500000, 500000}),
              0.75 * std::log(1.5) + 0.25 * std::log(0.5), 1e-5);
  // A class that is never generated has a large but finite cost.
  const double missing = FrequencyDivergence({500, 500}, {1000, 0});
  EXPECT_GT(missing, 1.0);
  EXPECT_TRUE(std::isfinite(missing));
  EXPECT_THROW(FrequencyDivergence({1, 2}, {1}), core::Error);
  EXPECT_THROW(FrequencyDivergence({}, {}), core::Error);
  EXPECT_THROW(FrequencyDivergence({-1}, {1}), core::Error);
}

TEST(AssetCounts, CountsObjectsByClass) {
  const Vocabulary words{"test", 4, {"cup", "plate", "table"}, {false, false, true}};
  std::vector<std::vector<SceneObject>> scenes(2);
  scenes[0].resize(3);
  scenes[0][0].category = "table", scenes[0][1].category = "cup", scenes[0][2].category = "cup";
  scenes[1].resize(1);
  scenes[1][0].category = "table";
  EXPECT_EQ(AssetCounts(scenes, words), (std::vector<std::int64_t>{2, 0, 2}));
  scenes[1][0].category = "spoon";
  EXPECT_THROW(AssetCounts(scenes, words), core::Error);
}

TEST(ClassifierAccuracy, CannotTellTwoSetsOfOneKind) {
  const std::vector<AccuracyScore> scores =
      ClassifierAccuracy(NormalRows(2000, 16, 1), NormalRows(2000, 16, 2));
  ASSERT_EQ(scores.size(), 2u);
  EXPECT_EQ(scores[0].passes, 50);
  EXPECT_EQ(scores[1].passes, 100);
  for (const AccuracyScore& score : scores) {
    EXPECT_GE(score.percent, 50.0);  // reflected
    EXPECT_LT(score.percent, 53.0);
  }
}

TEST(ClassifierAccuracy, CannotTellASetFromItself) {
  const FeatureMatrix features = NormalRows(2000, 16, 1);
  const AccuracyScore score = ClassifierAccuracy(features, features).back();
  EXPECT_GE(score.percent, 50.0);
  EXPECT_LT(score.percent, 53.0);
}

TEST(ClassifierAccuracy, TellsWhatIsApart) {
  const FeatureMatrix data = NormalRows(400, 8, 1);
  AccuracyOptions options;
  options.learning_rate = 1e-2;
  // A wall of 8 deviations between them: all are told apart. 2 deviations: normal(1) = 84%.
  for (const auto& [shift, percent, within] :
       {std::tuple(8.0f, 100.0, 0.5), std::tuple(2.0f, 84.1, 3.0)}) {
    FeatureMatrix generated = NormalRows(600, 8, 2);
    generated.col(5).array() += shift;
    const std::vector<AccuracyScore> scores = ClassifierAccuracy(data, generated, options);
    EXPECT_NEAR(scores.back().percent, percent, within);
    EXPECT_EQ(scores.back().percent, ClassifierAccuracy(data, generated, options).back().percent);
  }
}

TEST(ClassifierAccuracy, RefusesWhatIsNone) {
  const FeatureMatrix features = NormalRows(20, 3, 1);
  EXPECT_THROW(ClassifierAccuracy(features, NormalRows(20, 4, 1)), core::Error);
  EXPECT_THROW(ClassifierAccuracy(features, NormalRows(3, 3, 1)), core::Error);
  for (const std::vector<int>& scored : {std::vector<int>{}, {0}, {5, 5}, {9, 3}}) {
    AccuracyOptions options;
    options.scored_epochs = scored;
    EXPECT_THROW(ClassifierAccuracy(features, features, options), core::Error);
  }
}

}  // namespace
}  // namespace simwright::scene
