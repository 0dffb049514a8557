#pragma once

#include "capture/structure_from_motion.h"

namespace simwright::capture {

// The values of the lenses that an adjustment fits.
enum class LensFit {
  kUsual,  // focal length and two radial coefficients
  kFull    // also the principal point and the tangential coefficients, kept near their usual values
};

// Fits poses, points and lenses of a structure's placed photos to their tracks: bundle adjustment
// with a Huber loss (Ceres). `focal_priors`: per lens, EXIF's focal length, pixels; 0: none. The
// first placed photo's pose and the second one's distance from the origin are kept: the gauge. A
// lens that fewer than three placed photos share keeps its values.
void AdjustStructure(LensFit fit, const std::vector<double>& focal_priors, Structure* structure);

// Returns the point of the plane z = 1 that a lens shows at `pixel`, by fixed-point iteration.
Eigen::Vector2d DirectionOf(const Lens& lens, const Eigen::Vector2d& pixel);

}  // namespace simwright::capture
