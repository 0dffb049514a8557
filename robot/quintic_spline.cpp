#include "robot/quintic_spline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace simwright::robot {
namespace {

// The six pieces of the cardinal quintic B-spline over one interval, times 120: coefficients of 1,
// x, ..., x^5, x in [0, 1].
constexpr double kQuinticPieces[6][6] = {
    {1, -5, 10, -10, 5, -1},    {26, -50, 20, 20, -20, 5}, {66, 0, -60, 0, 30, -10},
    {26, 50, 20, -20, -20, 10}, {1, 5, 10, 10, 5, -5},     {0, 0, 0, 0, 0, 1},
};

}  // namespace

QuinticSpline::QuinticSpline(double spacing, Eigen::MatrixXd controls)
    : spacing_(spacing), controls_(std::move(controls)) {}

QuinticSpline::Basis QuinticSpline::At(double u, double spacing, Eigen::Index intervals,
                                       int derivative) {
  const double place = std::clamp(u / spacing, 0.0, static_cast<double>(intervals));
  Basis basis;
  basis.first = std::min(static_cast<Eigen::Index>(place), intervals - 1);
  const double x = place - static_cast<double>(basis.first);
  double scale = 1.0 / 120.0;
  double falling[6];  // x^power derived: power (power - 1) ...
  for (int power = 0; power < 6; ++power) {
    falling[power] = 1.0;
    for (int k = 0; k < derivative; ++k) falling[power] *= power - k;
  }
  for (int k = 0; k < derivative; ++k) scale /= spacing;
  for (std::size_t piece = 0; piece < kSupport; ++piece) {
    double sum = 0.0;
    for (int power = 5; power >= derivative; --power) {
      sum = sum * x + kQuinticPieces[piece][power] * falling[power];
    }
    basis.weights[piece] = scale * sum;
  }
  return basis;
}

Eigen::RowVectorXd QuinticSpline::Value(double u, int derivative) const {
  const Basis basis = At(u, spacing_, intervals(), derivative);
  Eigen::RowVectorXd value = Eigen::RowVectorXd::Zero(joints());
  for (int k = 0; k < kSupport; ++k) {
    value += basis.weights[static_cast<std::size_t>(k)] * controls_.row(basis.first + k);
  }
  return value;
}

QuinticSpline::Jet QuinticSpline::Values(double u) const {
  Eigen::Matrix<double, 4, kSupport> weights;
  Eigen::Index first = 0;
  for (int derivative = 0; derivative < 4; ++derivative) {
    const Basis basis = At(u, spacing_, intervals(), derivative);
    first = basis.first;
    for (int k = 0; k < kSupport; ++k) {
      weights(derivative, k) = basis.weights[static_cast<std::size_t>(k)];
    }
  }
  return weights.lazyProduct(controls_.middleRows<kSupport>(first));
}

}  // namespace simwright::robot
