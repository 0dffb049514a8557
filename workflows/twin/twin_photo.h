#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/finding.h"
#include "core/float_image.h"
#include "core/image.h"
#include "twin/table_depth.h"
#include "workflows/twin/twin.h"

namespace simwright::workflows {

// The photo of a twin with all that its files tell of the camera.
struct TwinPhoto {
  core::Image rgb;            // as used: scaled down
  int width = 0, height = 0;  // of the file
  double focal = 0.0;         // over the width; 0: unknown
  double log_focal_error = 0.0;
  Eigen::Vector2d principal{0.5, 0.5};    // point, in widths and heights
  core::FloatImage depth;                 // m, of the size of `rgb`; empty: none
  std::optional<twin::DepthPlane> plane;  // of the table, if there is depth
};

// Reads the photo, its calibration and its depth, and fits the table's plane to the latter. Throws
// core::Error for files that are unreadable or do not belong together, a photo in which nothing can
// be seen, and a depth without a table.
TwinPhoto ReadTwinPhoto(const TwinRequest& request, const TwinView& view, core::Findings* findings);

}  // namespace simwright::workflows
