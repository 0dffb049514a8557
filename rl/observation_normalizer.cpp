#include "rl/observation_normalizer.h"

#include <cmath>

namespace simwright::rl {
namespace {

constexpr double kSmallestVariance = 1e-8;

}  // namespace

ObservationScale::ObservationScale(int size)
    : mean_(Eigen::RowVectorXf::Zero(size)), factor_(Eigen::RowVectorXf::Ones(size)) {}

ObservationScale::ObservationScale(const RunningMoments& moments)
    : mean_(moments.mean.cast<float>().matrix().transpose()),
      factor_((moments.Variance() + kSmallestVariance).rsqrt().cast<float>().matrix().transpose()) {
}

ObservationScale::ObservationScale(const Eigen::RowVectorXf& mean, const Eigen::RowVectorXf& factor)
    : mean_(mean), factor_(factor) {}

void ObservationScale::Apply(const Rows& observations, Rows* scaled) const {
  scaled->resize(observations.rows(), observations.cols());
  for (Eigen::Index i = 0; i < observations.rows(); ++i) {
    for (Eigen::Index j = 0; j < observations.cols(); ++j) {
      const float value = (observations(i, j) - mean_[j]) * factor_[j];
      (*scaled)(i, j) = std::isfinite(value) ? std::min(kLimit, std::max(-kLimit, value)) : 0.0f;
    }
  }
}

void ObservationNormalizer::Update(const Rows& observations) {
  moments_.Add(observations);
  scale_ = ObservationScale(moments_);
}

void ObservationNormalizer::Restore(const RunningMoments& moments) {
  moments_ = moments;
  scale_ = ObservationScale(moments_);
}

}  // namespace simwright::rl
