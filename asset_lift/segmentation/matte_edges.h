#pragma once

#include <opencv2/core.hpp>

#include "core/image.h"

namespace simwright::asset_lift {

// Returns a photo (1, 3 or 4 channels) in BGR (CV_8UC3).
cv::Mat PhotoInBgr(const core::Image& photo);

// Returns a mask (CV_8U, 0 or 255, of about the photo's aspect ratio and smaller) as a soft matte
// of the photo's size (CV_8U): its edges are moved to the photo's, by at most `reach` pixels of the
// mask, by a guided filter at the photo's own resolution (He, Sun and Tang 2013).
cv::Mat RefineMatte(const cv::Mat& photo_bgr, const cv::Mat& mask, int reach);

}  // namespace simwright::asset_lift
