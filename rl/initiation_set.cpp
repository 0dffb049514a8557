#include "rl/initiation_set.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/error.h"

namespace simwright::rl {
namespace {

constexpr int kSteps = 30;                   // of Newton's method at most; five are usual
constexpr double kConverged = 1e-8;          // of the weights' change
constexpr double kSmallestDeviation = 1e-6;  // a smaller deviation: the number is constant
constexpr double kFarthest = 5.0;            // deviations: the clipping limit

double Logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

}  // namespace

InitiationSet::InitiationSet(const Rows& observations, const std::vector<bool>& succeeded,
                             double ridge) {
  const Eigen::Index count = observations.rows(), size = observations.cols();
  if (count == 0 || static_cast<size_t>(count) != succeeded.size()) {
    throw core::Error("an initiation set needs start states, each with an outcome");
  }
  const Eigen::MatrixXd values = observations.cast<double>();
  mean_ = values.colwise().mean();
  const Eigen::RowVectorXd deviation =
      ((values.rowwise() - mean_).colwise().squaredNorm() / static_cast<double>(count)).cwiseSqrt();
  factor_ = (deviation.array() > kSmallestDeviation)
                .select(deviation.cwiseMax(kSmallestDeviation).cwiseInverse(), 0.0);
  Eigen::MatrixXd inputs(count, size + 1);
  inputs.leftCols(size) = ((values.rowwise() - mean_).array().rowwise() * factor_.array())
                              .cwiseMin(kFarthest)
                              .cwiseMax(-kFarthest);
  inputs.col(size).setOnes();
  // Newton's method on the log likelihood, less ridge/2 |w|^2 of all weights; the bias has a
  // smaller penalty, which keeps it finite if all outcomes are equal.
  Eigen::VectorXd penalty = Eigen::VectorXd::Constant(size + 1, ridge);
  penalty[size] = std::min(ridge, 1e-2);
  weights_ = Eigen::VectorXd::Zero(size + 1);
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::VectorXd probability = (inputs * weights_).unaryExpr(&Logistic);
    Eigen::VectorXd missing(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      missing[i] = (succeeded[static_cast<size_t>(i)] ? 1.0 : 0.0) - probability[i];
    }
    const Eigen::VectorXd spread = probability.array() * (1.0 - probability.array());
    Eigen::MatrixXd curvature = inputs.transpose() * spread.asDiagonal() * inputs;
    curvature.diagonal() += penalty;
    const Eigen::VectorXd gradient = inputs.transpose() * missing - penalty.cwiseProduct(weights_);
    const Eigen::VectorXd change = curvature.ldlt().solve(gradient);
    weights_ += change;
    if (change.norm() < kConverged) break;
  }
}

double InitiationSet::SuccessProbability(const float* observation) const {
  const Eigen::Index size = mean_.size();
  double sum = weights_[size];
  for (Eigen::Index i = 0; i < size; ++i) {
    const double value = (static_cast<double>(observation[i]) - mean_[i]) * factor_[i];
    sum += weights_[i] * std::clamp(value, -kFarthest, kFarthest);
  }
  return Logistic(sum);
}

}  // namespace simwright::rl
