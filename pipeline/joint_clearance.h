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

// Over a joint's whole range, once with all other joints at zero and once with them at their
// upper limits. Collision parts are taken as convex. `joint` indexes model.joints.
Clearance SweptClearance(const assets::UrdfModel& model, int joint);

// Lowest point of all links over the joint's range, others at zero; m, in the root's frame.
double LowestOnSweep(const assets::UrdfModel& model, int joint);

}  // namespace simwright::pipeline
