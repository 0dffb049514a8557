#pragma once

namespace simwright::robot {

// What one joint can do. Units are rad, or m for a joint that slides.
struct JointLimits {
  double lower = 0.0, upper = 0.0;
  double velocity = 0.0;      // per s
  double acceleration = 0.0;  // per s^2
  double jerk = 0.0;          // per s^3
  double effort = 0.0;        // N m, or N for a joint that slides
};

// How far a command stays off the rates that a controller enforces. The defaults are libfranka's
// (include/franka/rate_limiting.h): 1e-3 off each rate, and off the velocity as much as three lost
// packets of 1 ms can add at full acceleration.
struct LimitMargin {
  double absolute = 1e-3;  // per s, s^2, s^3
  double delay = 3e-3;     // s
};

// `limits` with the margin taken off velocity, acceleration and jerk; positions and effort stay.
// Requires rates that exceed the margin.
JointLimits CommandLimits(const JointLimits& limits, const LimitMargin& margin);

}  // namespace simwright::robot
