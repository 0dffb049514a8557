#pragma once

#include <string>

#include "assets/urdf_reader.h"
#include "core/finding.h"

namespace simwright::pipeline {

// Lets an articulated model with collision parts (closed, convex), whose root stands on z = 0, stand
// in the engines, joints at zero:
//   where it falls over as it is given, it is turned into the stable pose that FindRestPose takes (a
//   pair of scissors lies);
//   what the root moves with is cut 1 % of the diagonal (at most 2 mm) above its lowest point, and
//   the whole set down, unless it stands on a flat of that extent already: hulls of a rounded or rough base end
//   in single corners, on which a bottle creeps.
// Masses are taken by volume. All frames stay parallel to the root's, whose origin stays in the
// middle below the whole. Returns findings for what was done.
core::Findings LetStand(assets::UrdfModel* model);

// How far inside its foot (the hull of what the root moves with, where it is within 1 mm of the
// floor z = 0) the whole's centre of mass stays while one joint moves over its range, others at
// zero; m, negative where it leaves the foot and the whole tips over. The model has inertials.
struct TippingMargin {
  double margin = 0.0;
  std::string joint;     // of which it is least
  double position = 0.0;  // rad or m
};
TippingMargin LeastTippingMargin(const assets::UrdfModel& model);

}  // namespace simwright::pipeline
