#pragma once

#include <vector>

#include "assets/asset.h"
#include "assets/urdf_reader.h"

namespace simwright::assets {

// What a joint carries, and what it has to be held against.
struct JointLoad {
  double mass = 0.0;     // kg, of all links beyond the joint
  double inertia = 0.0;  // kg m^2 about the axis, or kg along it
  double gravity = 0.0;  // N m or N, by which weight drives the joint up (+) or down (-)
};

// Of joint `joint` at `position` (rad or m), all others at zero, the root upright. `links` are the
// inertials in their frames, joints[i] leads to links[i + 1] from links[parents[i]].
JointLoad LoadOn(const std::vector<Inertial>& links, const std::vector<UrdfJoint>& joints,
                 const std::vector<int>& parents, int joint, double position);

}  // namespace simwright::assets
