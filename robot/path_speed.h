#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/joint_limits.h"

namespace simwright::robot {

// Derivatives of J joints by the parameter w on a fine, uniform grid over [0, length].
struct PathDerivatives {
  double step = 0.0;                     // of the grid
  Eigen::MatrixXd first, second, third;  // (J x points)
};

// The greatest speeds dw/dt (points) with which the path can be run within the limits of velocity
// and acceleration, jerk left aside, and at most `most` (points): time-optimal parameterization by
// reachability (Pham and Pham 2018). From the end back, the set of speeds from which the next
// point's set can be reached; then forward as fast as these sets allow.
std::vector<double> FastestSpeeds(const PathDerivatives& path,
                                  const std::vector<JointLimits>& limits,
                                  const std::vector<double>& most);

}  // namespace simwright::robot
