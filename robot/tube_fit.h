#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::robot {

// What a fitted curve must keep to.
struct Tube {
  double radius = 2e-3;             // of the way from each sample, same parameter
  double lower = 0.0, upper = 0.0;  // of the whole curve
};

// A smooth curve through a tube round samples of one joint: control points (intervals + 5) of a
// QuinticSpline of `spacing` that passes each value (K, at `times`, 0 to intervals * spacing)
// within tube.radius, starts and ends at the first and the last, stays within the limits, and has
// little third derivative: least squares with a penalty on the control points' third differences
// (P-splines, Eilers and Marx 1996), where samples that were missed count more in the next round.
// `spacing` is that of the samples or a whole part of it: near a limit, which no control point
// passes, a finer curve turns more sharply. Empty where no such curve was found.
Eigen::VectorXd FitInTube(const std::vector<double>& times, const Eigen::VectorXd& values,
                          double spacing, const Tube& tube);

}  // namespace simwright::robot
