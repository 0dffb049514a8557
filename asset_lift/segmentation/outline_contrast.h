#pragma once

#include <opencv2/core.hpp>

#include "core/image.h"

namespace simwright::asset_lift {

// Returns the share of the outline of `mask` (CV_8U, as large as the photo, one region) along which
// the photo looks the same on both sides: a difference below 6 in CIELAB between points inside and
// outside, 1.2 % of the photo's longer side apart from it. Photos of objects have 0 to 0.1; cutouts
// of an empty table or of clear glass have 0.8 and more. Returns 0 where the outline is too short.
double WeakOutlineShare(const core::Image& photo, const cv::Mat& mask);

}  // namespace simwright::asset_lift
