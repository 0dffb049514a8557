#pragma once

#include <Eigen/Core>

#include "rl/running_moments.h"
#include "rl/vector_environment.h"

namespace simwright::rl {

// Shifts and scales each number of an observation to mean 0 and standard deviation 1, by constants.
// A number that never changed is only shifted and scaled by 1e4, so that it stays 0.
class ObservationScale {
 public:
  // The clipping limit: one outlier must not swamp a network.
  static constexpr float kLimit = 10.0f;

  // Leaves observations of `size` numbers unchanged, except for the clipping.
  explicit ObservationScale(int size = 0);
  explicit ObservationScale(const RunningMoments& moments);
  // `factor`: one over the standard deviation.
  ObservationScale(const Eigen::RowVectorXf& mean, const Eigen::RowVectorXf& factor);

  // Maps (n x O) to (n x O), in place if both are the same. A number that is not finite becomes 0.
  void Apply(const Rows& observations, Rows* scaled) const;

  const Eigen::RowVectorXf& mean() const { return mean_; }
  const Eigen::RowVectorXf& factor() const { return factor_; }

 private:
  Eigen::RowVectorXf mean_, factor_;
};

// An ObservationScale that is updated with the observations during training.
class ObservationNormalizer {
 public:
  explicit ObservationNormalizer(int size) : moments_(size), scale_(size) {}

  void Update(const Rows& observations);
  void Apply(const Rows& observations, Rows* scaled) const { scale_.Apply(observations, scaled); }

  // Returns the current scale, to be frozen into a policy.
  const ObservationScale& scale() const { return scale_; }
  const RunningMoments& moments() const { return moments_; }
  void Restore(const RunningMoments& moments);

 private:
  RunningMoments moments_;
  ObservationScale scale_;
};

}  // namespace simwright::rl
