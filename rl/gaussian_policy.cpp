#include "rl/gaussian_policy.h"

#include <cmath>
#include <numbers>

namespace simwright::rl {

void SampleActions(const Rows& means, const Eigen::RowVectorXf& std, core::Rng& rng,
                   Rows* actions) {
  actions->resize(means.rows(), means.cols());
  for (Eigen::Index i = 0; i < means.rows(); ++i) {
    for (Eigen::Index j = 0; j < means.cols(); ++j) {
      (*actions)(i, j) = means(i, j) + std[j] * static_cast<float>(core::Normal(rng));
    }
  }
}

Eigen::VectorXf LogDensity(const Rows& actions, const Rows& means, const Eigen::RowVectorXf& std) {
  const auto constant = static_cast<float>(0.5 * std::log(2.0 * std::numbers::pi) *
                                           static_cast<double>(means.cols()));
  const Rows turned = (actions - means).array().rowwise() / std.array();
  return (-0.5f * turned.rowwise().squaredNorm().array()) - std.array().log().sum() - constant;
}

}  // namespace simwright::rl
