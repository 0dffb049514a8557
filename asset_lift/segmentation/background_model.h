#pragma once

#include <opencv2/core.hpp>

#include "asset_lift/segmentation/segmentation.h"
#include "core/image.h"

namespace simwright::asset_lift {

// Returns the soft foreground (CV_8U, the photo's size) of a photo without mask or alpha channel:
// pixels unlike the border's colours, weighted by saliency, grown by GrabCut, with edges refined by
// a guided filter. Throws core::Error where foreground and background cannot be separated.
cv::Mat FindForeground(const core::Image& photo, const SegmentationOptions& options);

}  // namespace simwright::asset_lift
