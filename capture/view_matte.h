#pragma once

#include "asset_lift/segmentation/segmentation.h"
#include "capture/capture.h"

namespace simwright::capture {

// Returns a view's mask as a matte. It is empty (right <= left) where the mask shows nothing.
asset_lift::Matte MatteOf(const CaptureView& view);

}  // namespace simwright::capture
