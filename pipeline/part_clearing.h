#pragma once

#include "assets/urdf_reader.h"
#include "core/finding.h"

namespace simwright::pipeline {

struct ClearingOptions {
  // Overlap that is taken for a file's sloppiness and trimmed away, m: models of furniture are
  // drawn to a few millimetres.
  double most = 0.005;
  // m, what is left between parts that were trimmed, as between fitted doors: with 1 mm a joint
  // that is held at its limit touches when another one swings.
  double gap = 0.003;
  bool on_floor = false;  // also lifts what moves off the floor, where the root stands on it
};

// Trims the collision parts (closed, convex) of links that move, so that over each joint's whole
// range, others at zero and at their upper limits, they clear what the joint moves them against:
// each part is cut by the planes that part it from what it overlaps. Of two links that overlap by
// more than `most` anywhere on the way the parts stay as they are; where one moving joint lies
// between the two they go into model->excluded_pairs, as MuJoCo and SAPIEN make no contact between
// a parent and its child. Returns a finding for each pair that was trimmed, excluded
// ("contact-excluded") or left overlapping ("overlap"); the figure is the deepest overlap, mm.
core::Findings ClearMovingParts(const ClearingOptions& options, assets::UrdfModel* model);

}  // namespace simwright::pipeline
