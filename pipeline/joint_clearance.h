#pragma once

#include <string>

#include "assets/urdf_reader.h"

namespace simwright::pipeline {

// The nearest that any two links come that a joint moves against each other.
struct Clearance {
  double distance = 0.0;  // m; negative: they overlap by so much; infinite: nothing is near
  double position = 0.0;  // of the joint, rad or m, where it is least
  std::string pair;       // "door and body"
};

// Over a joint's whole range, all other joints at zero, or (`others_up`) at their upper limits.
// Collision parts are taken as convex; pairs that are excluded from contact do not count. `joint`
// indexes model.joints.
Clearance SweptClearance(const assets::UrdfModel& model, int joint, bool others_up);
// The lesser of both.
Clearance SweptClearance(const assets::UrdfModel& model, int joint);

// Lowest point of all links that the joint carries, over its range, others at zero; m, in the root's
// frame. Links that stand on the floor at zero while the root does not (a cart's wheels) do not
// count; infinite where none is left.
double LowestOnSweep(const assets::UrdfModel& model, int joint);

}  // namespace simwright::pipeline
