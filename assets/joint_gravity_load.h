#pragma once

#include <vector>

#include "assets/asset.h"
#include "assets/urdf_reader.h"

namespace simwright::assets {

// The load on a joint.
struct JointLoad {
  double mass = 0.0;     // kg, of all links beyond the joint
  double inertia = 0.0;  // kg m^2 about the axis, or kg along it
  double gravity = 0.0;  // N m or N, positive where the weight drives the joint towards larger
                         // positions
};

// Returns the load on joint `joint` at `position` (rad or m), with all others at zero and the root
// upright. `links` are the inertials in their frames; joints[i] connects links[parents[i]] to
// links[i + 1].
JointLoad LoadOn(const std::vector<Inertial>& links, const std::vector<UrdfJoint>& joints,
                 const std::vector<int>& parents, int joint, double position);

}  // namespace simwright::assets
