#pragma once

#include "asset_lift/lift.h"
#include "asset_lift/mesh_fit/shape_fit_options.h"
#include "capture/capture.h"
#include "capture/start_shape.h"
#include "core/progress.h"

namespace simwright::capture {

struct CaptureLiftOptions {
  asset_lift::ShapeFitOptions fit;
  int fit_side = 320;       // pixels of the longer side of the views that the mesh is fitted to
  int texture_size = 2048;  // pixels per side
  StartShapeOptions start;
  std::uint64_t seed = 1;

  CaptureLiftOptions();
};

// Reconstructs the captured object: its hull, which stands flat on the mat and is carved by stereo
// (start_shape.h), is fitted to masks, colours and depths and textured from all photos. Of the
// surfaces that fit, the smallest is preferred, unless stereo carved much of the hull. Surfaces
// that no photo shows take the fitted colours. In the mat's frame, m; its camera and photo are the
// first view's. Throws core::Error for a capture without a masked view, and the exceptions of
// FitShape; core::Cancelled.
asset_lift::LiftedMesh LiftCapture(const Capture& capture, const CaptureLiftOptions& options,
                                   core::Progress* progress);

// The same from a start shape of this capture.
asset_lift::LiftedMesh LiftCapture(const Capture& capture, const StartShape& start,
                                   const CaptureLiftOptions& options, core::Progress* progress);

}  // namespace simwright::capture
