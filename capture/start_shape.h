#pragma once

#include "capture/capture.h"
#include "capture/flat_tops.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::capture {

struct StartShapeOptions {
  int cells = 128;                // along the longest side of the grid
  double tolerated_views = 0.05;  // share of the views whose masks may exclude a point
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
