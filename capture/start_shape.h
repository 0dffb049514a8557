#pragma once

#include <vector>

#include "asset_lift/camera/observed_view.h"
#include "capture/capture.h"
#include "capture/depth_carving.h"
#include "capture/hull_field.h"
#include "capture/stereo_depth.h"
#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::capture {

struct StartShapeOptions {
  HullFieldOptions field;
  bool use_stereo = true;
  StereoOptions stereo;
  DepthCarvingOptions carving;
  double least_share = 0.01;  // of the object's pixels with a depth: fewer are not used
};

// The shape that a fit starts from, with the views that it is fitted to.
struct StartShape {
  std::vector<asset_lift::ObservedView> views;  // of the masks that show something, in their order
  core::TriangleMesh mesh;                      // closed, world, m
  double depth_share = 0.0;  // of the object's pixels whose depth stereo found; 0: none is used
};

// Crops a capture's views to the object, `side` pixels a side, finds the depths of textured
// surfaces by stereo, and carves the hull by them. Without texture the mesh is the hull, and the
// views have no depths. Throws core::Error for a capture without a masked view; core::Cancelled.
StartShape MakeStartShape(const Capture& capture, int side, const StartShapeOptions& options,
                          core::Progress* progress);

}  // namespace simwright::capture
