#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/joint_limits.h"

namespace simwright::robot {

// Derivatives of J joints with respect to the path parameter w on a fine, uniform grid over [0,
// length].
struct PathDerivatives {
  double step = 0.0;                     // grid spacing
  Eigen::MatrixXd first, second, third;  // (J x points)
};

// Returns the largest path speeds dw/dt (points) within the velocity and acceleration limits, and
// at most `most` (points); jerk is ignored. Time-optimal path parameterization by reachability
// (TOPP-RA, Pham and Pham 2018): a backward pass computes the controllable sets of speeds, a
// forward pass takes the largest speed in each set.
std::vector<double> MaxPathSpeeds(const PathDerivatives& path,
                                  const std::vector<JointLimits>& limits,
                                  const std::vector<double>& most);

}  // namespace simwright::robot
