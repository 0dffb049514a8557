#pragma once

#include <array>

#include <Eigen/Core>

namespace simwright::robot {

// A curve of J joints over a parameter u in [0, intervals * spacing]: a quintic B-spline on uniform
// knots, four times continuously differentiable, that stays between the smallest and the largest of
// its control points.
class QuinticSpline {
 public:
  static constexpr int kSupport = 6;  // control points that shape one interval
  using Jet = Eigen::Matrix<double, 4, Eigen::Dynamic>;

  // The interval of u, and the weights of the control points first ... first + 5 there, for the
  // `derivative`-th derivative, 0 to 3.
  struct Basis {
    Eigen::Index first = 0;
    std::array<double, kSupport> weights{};
  };

  // `controls`: (intervals + 5) x J.
  QuinticSpline(double spacing, Eigen::MatrixXd controls);

  static Basis At(double u, double spacing, Eigen::Index intervals, int derivative);

  Eigen::Index intervals() const { return controls_.rows() - (kSupport - 1); }
  double length() const { return spacing_ * static_cast<double>(intervals()); }
  Eigen::Index joints() const { return controls_.cols(); }
  // Returns the value or a derivative (J) at `u`, clamped to the ends of the curve.
  Eigen::RowVectorXd Value(double u, int derivative = 0) const;
  // Returns the value and the first three derivatives (4 x J), as Value does.
  Jet Values(double u) const;

 private:
  double spacing_;
  Eigen::MatrixXd controls_;
};

}  // namespace simwright::robot
