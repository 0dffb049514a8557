#pragma once

#include <opencv2/core.hpp>

#include "asset_lift/segmentation/salient_network.h"
#include "asset_lift/segmentation/segmentation.h"
#include "core/image.h"

namespace simwright::asset_lift {

// Returns the soft foreground (CV_8U, the photo's size) that `network` sees. Where the network is
// certain it decides; GrabCut decides by the photo's colours where it is not, which is along the
// outline and at parts thinner than a pixel of the network. Throws core::Error where the network
// sees no object, and wherever SalientNetwork::Predict throws.
cv::Mat FindForegroundByNetwork(const core::Image& photo, SalientNetwork* network,
                                const SegmentationOptions& options);

}  // namespace simwright::asset_lift
