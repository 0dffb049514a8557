#pragma once

#include <string>

#include "assets/urdf_reader.h"

namespace simwright::validation {

// The minimum distance between any two links that a joint moves relative to each other.
struct Clearance {
  double distance = 0.0;  // m; negative: penetration depth; infinite: no pair is near
  double position = 0.0;  // the joint position of the minimum, rad or m
  std::string pair;       // "door and body"
};

// Computes the clearance over a joint's whole range, with all other joints at zero or (`others_up`)
// at their upper limits. Collision parts are assumed convex; pairs excluded from contact do not
// count. `joint` indexes model.joints.
Clearance SweptClearance(const assets::UrdfModel& model, int joint, bool others_up);
// Returns the smaller clearance of both settings of `others_up`.
Clearance SweptClearance(const assets::UrdfModel& model, int joint);

// Returns the lowest point of all links that the joint carries, over its range, with other joints
// at zero; m, in the root's frame. Links that touch the floor at zero while the root does not (a
// cart's wheels) do not count. Returns infinity if no link is left.
double LowestOnSweep(const assets::UrdfModel& model, int joint);

}  // namespace simwright::validation
