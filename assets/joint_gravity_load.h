#pragma once

#include "assets/kinematic_model.h"

namespace simwright::assets {

// The load on a joint.
struct JointLoad {
  double mass = 0.0;     // kg, of all links beyond the joint
  double inertia = 0.0;  // kg m^2 about the axis, or kg along it
  double gravity = 0.0;  // N m or N, positive where the weight drives the joint towards larger
                         // positions
};

// Returns the load on joint `joint` at `position` (rad or m), with all others at zero and the root
// upright.
JointLoad LoadOn(const KinematicModel& model, int joint, double position);

}  // namespace simwright::assets
