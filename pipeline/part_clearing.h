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
// each part is cut by the planes that part it from what it overlaps. A pair that overlaps by more
// than `most` anywhere on the way stays as it is. Returns a finding for each pair of links that was
// trimmed (figure: deepest overlap, mm) or left overlapping.
core::Findings ClearMovingParts(const ClearingOptions& options, assets::UrdfModel* model);

}  // namespace simwright::pipeline
