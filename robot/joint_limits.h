#pragma once

namespace simwright::robot {

// The limits of one joint, in rad, or in m for a prismatic joint.
struct JointLimits {
  double lower = 0.0, upper = 0.0;
  double velocity = 0.0;      // per s
  double acceleration = 0.0;  // per s^2
  double jerk = 0.0;          // per s^3
  double effort = 0.0;        // N m, or N for a prismatic joint
};

// The margin between a command and the rates that a controller enforces. The defaults are
// libfranka's (include/franka/rate_limiting.h): 1e-3 below each rate, and below the velocity also
// the increase that three lost packets of 1 ms can cause at full acceleration.
struct LimitMargin {
  double absolute = 1e-3;  // per s, s^2, s^3
  double delay = 3e-3;     // s
};

// Returns `limits` with the margin subtracted from velocity, acceleration and jerk; positions and
// effort are unchanged. Requires rates above the margin.
JointLimits CommandLimits(const JointLimits& limits, const LimitMargin& margin);

}  // namespace simwright::robot
