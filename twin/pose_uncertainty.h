#pragma once

#include "core/camera.h"
#include "twin/table_fit.h"

namespace simwright::twin {

// One standard deviation of a fitted object's pose and size.
struct PoseUncertainty {
  double position = 0.0;  // m, of each axis in the plane
  double yaw = 0.0;       // rad
  double size = 0.0;      // of the logarithm
};

// Returns how far an object may be from its fit. Its outline is off by
//   e = 0.004 w + 0.15 (1 - IoU) s
// pixels in a picture of width w, s being the diagonal of `box`; twice that if the object is partly
// hidden. Across the line of sight that is e d / f at distance d, and along the plane away from the
// camera e d / (f sin(a)), a being the angle of the line of sight to the plane. The yaw is off by e
// over half the longer side in pixels; the size by e / s and the scale of all lengths together.
// Wrong kinds and occlusions make larger errors than that (docs/twin.md).
PoseUncertainty UncertaintyOf(const TableFit& fit, const Eigen::AlignedBox2d& box,
                              const core::Camera& camera, bool hidden, double log_scale_error);

}  // namespace simwright::twin
