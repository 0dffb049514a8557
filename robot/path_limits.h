#pragma once

#include <vector>

#include <Eigen/Core>

#include "robot/joint_limits.h"
#include "robot/path_speed.h"
#include "robot/time_law.h"

namespace simwright::robot {

// The limits of J joints along a path as conditions on the slowness s of its time law and on its
// derivatives s', s'' with respect to the path parameter w. With the ratios p = s' / s and
// z = 3 p^2 - s'' / s, and the derivatives d1, d2, d3 of a joint with respect to w:
//   velocity      d1 / s
//   acceleration  (d2 - p d1) / s^2
//   jerk          (d3 - 3 p d2 + z d1) / s^3
class PathLimits {
 public:
  // `path` must outlive this object.
  PathLimits(const PathDerivatives& path, const std::vector<JointLimits>& limits);

  Eigen::Index points() const { return path_.first.cols(); }
  // Returns true if all values at `point` are within `share` of their limits.
  bool Hold(Eigen::Index point, const TimeLaw::Slowness& slowness, double share) const {
    return Excess(point, slowness, share, false) <= 1.0;
  }
  // Returns the factor by which a uniform slowness would have to grow for all values to be within
  // `share` of their limits: velocity falls with it, acceleration with its square, jerk with its
  // cube. At most 1: they are.
  double Excess(Eigen::Index point, const TimeLaw::Slowness& slowness, double share) const {
    return Excess(point, slowness, share, true);
  }

 private:
  // If not `exact`, the result says only whether it exceeds 1.
  double Excess(Eigen::Index point, const TimeLaw::Slowness& slowness, double share,
                bool exact) const;

  const PathDerivatives& path_;
  Eigen::ArrayXd per_acceleration_, per_jerk_;  // (J) 1 / limit
  // Largest values of the joints at each point, relative to their limits: the derivatives in the
  // order velocity: d1; acceleration: d1, d2; jerk: d1, d2, d3.
  Eigen::Matrix<double, 6, Eigen::Dynamic> largest_;
};

}  // namespace simwright::robot
