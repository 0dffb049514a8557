#pragma once

#include "assets/urdf_reader.h"
#include "core/finding.h"

namespace simwright::importers {

struct CollisionTrimmingOptions {
  // The overlap that counts as a modelling tolerance and is trimmed away, m: furniture models are
  // accurate to a few millimetres.
  double most = 0.005;
  // The gap left between trimmed parts, m, as between fitted doors. With 1 mm, a joint held at its
  // limit touches when another one moves.
  double gap = 0.003;
  bool on_floor = false;  // also trims moving links off the floor, if the root stands on it
};

// Trims the collision parts (closed, convex) of moving links until they are collision-free over
// each joint's whole range, with other joints at zero and at their upper limits: each part is cut
// by the planes that separate it from the parts it overlaps. If two links overlap by more than
// `most` anywhere in the range, their parts are unchanged; if one moving joint lies between them,
// the pair is added to model->excluded_pairs, because MuJoCo and SAPIEN make no contact between a
// parent and its child. Returns a finding for each pair that was trimmed, excluded
// ("contact-excluded") or left overlapping ("overlap"); the figure is the deepest overlap in mm.
core::Findings TrimMovingParts(const CollisionTrimmingOptions& options, assets::UrdfModel* model);

}  // namespace simwright::importers
