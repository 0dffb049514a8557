#pragma once

namespace simwright::sim {

// All that drives or resists a joint: a target velocity within force bounds (a motor, or dry
// friction: target 0 within +-friction), and a damper.
struct JointMotor {
  double velocity = 0.0;                           // rad/s or m/s
  double lowest_force = 0.0, highest_force = 0.0;  // N m or N; the lowest is negative
  double damping = 0.0;                            // N m s/rad or N s/m
};

// A joint's drive as one implicit constraint of the solver: it is solved together with the
// contacts. As separate constraints, damper and friction of a light link would take hundreds of
// iterations to converge. Its impulse is (target - velocity) inertia - compliance impulse, within
// the bounds.
struct MotorRow {
  double target = 0.0, inertia = 0.0, compliance = 0.0, lower = 0.0, upper = 0.0;
};

// `inertia`: the joint's effective inertia (kg m^2 or kg). `velocity`: the joint's, at the end of
// the step `dt` (s) without constraints.
MotorRow MakeMotorRow(const JointMotor& drive, double inertia, double velocity, double dt);

}  // namespace simwright::sim
