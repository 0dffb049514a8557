#pragma once

#include "core/camera.h"
#include "core/float_image.h"

namespace simwright::asset_lift {

// An observed image of the object with its camera: the target of a fit.
struct ObservedView {
  core::Camera camera;
  core::FloatImage color;    // (H x W x 3), sRGB in [0, 1]; meaningless where the mask is 0
  core::FloatImage opacity;  // (H x W x 1), the object's share of each pixel in [0, 1]
  core::FloatImage depth;    // (H x W x 1), m along the optical axis, 0 unknown; empty: no depths
};

}  // namespace simwright::asset_lift
