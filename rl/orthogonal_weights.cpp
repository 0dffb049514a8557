#include "rl/orthogonal_weights.h"

#include <algorithm>

#include <Eigen/QR>

namespace simwright::rl {

Eigen::MatrixXd OrthogonalWeights(int rows, int columns, double gain, core::Rng& rng) {
  const int longer = std::max(rows, columns), shorter = std::min(rows, columns);
  Eigen::MatrixXd gaussian(longer, shorter);
  for (double& value : gaussian.reshaped()) value = core::Normal(rng);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(gaussian);
  Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(longer, shorter);
  for (int j = 0; j < shorter; ++j) {
    if (qr.matrixQR()(j, j) < 0.0) q.col(j) *= -1.0;
  }
  q *= gain;
  if (rows < columns) return q.transpose();
  return q;
}

}  // namespace simwright::rl
