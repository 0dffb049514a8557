#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "robot/joint_limits.h"
#include "robot/joint_trajectory.h"

namespace simwright::robot {

// The value of a joint that comes nearest to its limit, or exceeds it most.
struct WorstValue {
  double value = 0.0;  // signed, rad or m, per s, s^2, s^3, or N m
  double limit = 0.0;  // of its absolute value; of a position the bound on its side
  double ratio = 0.0;  // 1 at the limit; of a position: its way from the middle of the range
  double time = 0.0;   // s
};

struct JointLimitReport {
  std::string joint;
  WorstValue position, velocity, acceleration, jerk, effort;  // effort: 0 where none is given
};

struct LimitReport {
  std::vector<JointLimitReport> joints;
  // An error for each joint and quantity that is exceeded ("limit-position", "limit-velocity",
  // "limit-acceleration", "limit-jerk", "limit-effort"), derivatives that are not those of the
  // positions ("velocity-mismatch", "acceleration-mismatch"), and motion at either end ("no-rest").
  core::Findings findings;

  bool accepted() const { return findings.empty(); }
};

// Checks what a controller would see, knowing nothing of how `trajectory` was made. Velocity,
// acceleration and jerk are the larger of what is given and of divided differences, up to the
// third of the positions; a given derivative must agree with the positions as far as a motion
// within its limit of jerk can tell. At both ends velocity and acceleration must be zero to 1e-6.
// `limits`: (J), as CommandLimits gives them for what a controller shall accept; an effort of 0 is
// no limit. Throws core::Error where the trajectory is not whole, lacks velocities or
// accelerations, or there are not J limits.
LimitReport CheckLimits(const JointTrajectory& trajectory, const std::vector<JointLimits>& limits);

}  // namespace simwright::robot
