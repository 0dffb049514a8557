#pragma once

#include "capture/capture.h"
#include "capture/flat_tops.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::capture {

struct StartShapeOptions {
  int cells = 128;  // along the longest side of the grid
  // The share of the views whose masks may exclude a point of a first hull. Even one view in twenty
  // lets a flat side bulge, because few views look along it.
  double tolerated_views = 0.05;
  // A mask that agrees with the first hull's silhouette to this intersection over union is then
  // believed at its outline, and no view is tolerated. The masks' holes deeper in the silhouette
  // than `hole_depth` (share of the root of its area) are filled first.
  double least_agreement = 0.9;
  double hole_depth = 0.06;
  bool lower_peaks = true;
  FlatTopOptions flat_tops;
};

struct StartShape {
  core::TriangleMesh mesh;  // closed, oriented, flat on z = 0; m
};

// Returns the shape that a fit starts from: the visual hull, its peaks lowered to planes where the
// outlines allow it. Throws core::Error for invalid views; core::Cancelled.
StartShape MakeStartShape(const Capture& capture, const StartShapeOptions& options,
                          core::Progress* progress);

}  // namespace simwright::capture
