#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::robot {

// The bounds of a fitted curve.
struct Tube {
  double radius = 2e-3;             // largest distance from each sample, at its parameter
  double lower = 0.0, upper = 0.0;  // bounds of the whole curve
};

// Fits a smooth curve through a tube around samples of one joint. Returns the control points
// (intervals + 5) of a QuinticSpline of `spacing` that passes each value (K, at `times`, 0 to
// intervals * spacing) within tube.radius, starts and ends at the first and the last sample, stays
// within the limits, and has a small third derivative: least squares with a penalty on the third
// differences of the control points (P-splines, Eilers and Marx 1996), where the weights of missed
// samples grow between iterations. `spacing` is the sample spacing divided by a whole number: near
// a limit, which no control point passes, a finer curve can turn more sharply. Returns an empty
// vector if no such curve was found. `weights` (K, or empty) are those of the samples at the start
// and, if a curve is found, at the end: those of a wider tube spare iterations.
Eigen::VectorXd FitWithinTube(const std::vector<double>& times, const Eigen::VectorXd& values,
                              double spacing, const Tube& tube, Eigen::VectorXd* weights);

}  // namespace simwright::robot
