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

using Pieces = std::array<std::array<double, 6>, QuinticSpline::kSupport>;

// Returns the pieces and their first three derivatives.
constexpr std::array<Pieces, 4> DerivedPieces() {
  std::array<Pieces, 4> derived{};
  for (std::size_t piece = 0; piece < QuinticSpline::kSupport; ++piece) {
    for (std::size_t power = 0; power < 6; ++power) {
      derived[0][piece][power] = kQuinticPieces[piece][power];
    }
    for (std::size_t order = 1; order < 4; ++order) {
      for (std::size_t power = 0; power < 5; ++power) {
        derived[order][piece][power] =
            static_cast<double>(power + 1) * derived[order - 1][piece][power + 1];
      }
    }
  }
  return derived;
}
constexpr std::array<Pieces, 4> kDerived = DerivedPieces();

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
  for (int k = 0; k < derivative; ++k) scale /= spacing;
  for (std::size_t piece = 0; piece < kSupport; ++piece) {
    const auto& c = kDerived[static_cast<std::size_t>(derivative)][piece];
    basis.weights[piece] =
        scale * (c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))));
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
