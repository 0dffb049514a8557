#pragma once

#include "asset_lift/capture/capture.h"
#include "asset_lift/lift.h"
#include "asset_lift/mesh_fit/shape_fit_options.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct CaptureLiftOptions {
  ShapeFitOptions fit;
  int fit_side = 320;  // pixels of the longer side of the views that the mesh is fitted to
  int texture_size = 2048;
  std::uint64_t seed = 1;

  CaptureLiftOptions();
};

// Reconstructs the captured object: its hull is fitted to masks and colours, kept on the mat's
// plane, closed flat below, and textured from all photos. In the mat's frame, m; its camera and
// photo are the first view's. Throws the exceptions of FitShape; core::Cancelled.
LiftedMesh LiftCapture(const Capture& capture, const CaptureLiftOptions& options,
                       core::Progress* progress);

}  // namespace simwright::asset_lift
