#pragma once

#include <opencv2/core.hpp>

#include "core/image.h"

namespace simwright::asset_lift {

// The share of the outline of `mask` (CV_8U, as large as the photo, one region) along which the
// photo looks the same on both sides: a difference below 6 in CIELAB between points 1.2 % of the
// photo's longer side apart from it, inside and outside. Photos of things have 0 to 0.1, what was
// cut out of an empty table or of clear glass 0.8 and more. 0 where the outline is too short to
// tell.
double WeakOutlineShare(const core::Image& photo, const cv::Mat& mask);

}  // namespace simwright::asset_lift
