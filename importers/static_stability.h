#pragma once

#include <string>

#include "assets/urdf_reader.h"
#include "core/finding.h"

namespace simwright::importers {

// Makes an articulated model with collision parts (closed, convex), whose root stands on z = 0,
// statically stable in the engines with joints at zero:
//   if it falls over in the given pose, it is rotated into the stable pose that FindRestPose
//   returns (a pair of scissors lies flat);
//   the collision parts that move with the root are cut 1 % of the diagonal (at most 2 mm) above
//   their lowest point and the whole model is lowered, unless it already stands on a flat face of
//   that extent: hulls of a rounded or rough base end in single corners, on which a bottle creeps.
// Masses follow volume. All frames stay parallel to the root's, whose origin stays centred below
// the whole model. Returns findings for all changes.
core::Findings MakeStaticallyStable(assets::UrdfModel* model);

// The smallest distance of the whole model's centre of mass to the edge of its support polygon (the
// hull of the root's group within 1 mm of the floor z = 0) while one joint moves over its range,
// with others at zero; m, negative if it leaves the polygon and the model tips over. The model must
// have inertials.
struct TippingMargin {
  double margin = 0.0;
  std::string joint;      // the joint of the minimum
  double position = 0.0;  // that joint's, rad or m
};
TippingMargin LeastTippingMargin(const assets::UrdfModel& model);

}  // namespace simwright::importers
