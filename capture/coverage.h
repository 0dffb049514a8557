#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/finding.h"

namespace simwright::capture {

// A camera's direction from the object, rad.
struct ViewDirection {
  double azimuth = 0.0;    // from +x, in (-pi, pi]
  double elevation = 0.0;  // above the horizontal plane
};
ViewDirection DirectionTo(const Eigen::Vector3d& object, const Eigen::Vector3d& camera);

// Returns what would improve a capture, one finding each (code "more-photos"): an empty sector of
// over 60 degrees around the object (a warning over 150 degrees: the far side is a guess), no photo
// from below 25 degrees (the height of flat tops stays uncertain), none from above 50 degrees
// (hollows stay filled).
core::Findings MissingViews(const std::vector<ViewDirection>& directions);

}  // namespace simwright::capture
