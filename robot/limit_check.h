#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "robot/joint_limits.h"
#include "robot/joint_trajectory.h"

namespace simwright::robot {

// The value of a joint that is nearest to its limit, or exceeds it most.
struct WorstValue {
  double value = 0.0;  // signed, rad or m, per s, s^2, s^3, or N m
  double limit = 0.0;  // of the absolute value; for a position the nearer bound
  double ratio = 0.0;  // 1 at the limit; for a position: distance from the middle of its range
  double time = 0.0;   // s
};

struct JointLimitReport {
  std::string joint;
  WorstValue position, velocity, acceleration, jerk, effort;  // effort: 0 where none is given
};

struct LimitReport {
  std::vector<JointLimitReport> joints;
  // An error for each joint and quantity over its limit ("limit-position", "limit-velocity",
  // "limit-acceleration", "limit-jerk", "limit-effort"), for given derivatives that disagree with
  // the positions ("velocity-mismatch", "acceleration-mismatch"), and for motion at either end
  // ("no-rest").
  core::Findings findings;

  bool accepted() const { return findings.empty(); }
};

// Checks a trajectory as a controller sees it, independently of how `trajectory` was generated.
// Velocity, acceleration and jerk are the larger of the given values and the divided differences,
// up to the third difference of the positions; a given derivative must agree with the positions
// within the tolerance of a jerk-limited motion. Velocity and acceleration must be zero to 1e-6 at
// both ends. `limits` (J): from CommandLimits for commands to a controller; an effort of 0 means no
// limit. Throws core::Error if the trajectory is malformed, lacks velocities or accelerations, or
// `limits` does not have J entries.
LimitReport CheckLimits(const JointTrajectory& trajectory, const std::vector<JointLimits>& limits);

}  // namespace simwright::robot
