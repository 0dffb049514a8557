#pragma once

#include "assets/articulated_asset.h"
#include "core/image.h"

namespace simwright::pipeline {

// The asset from the front and a little from its right and above, all joints at `open` of their
// range (0: at zero, closed; 1: at the upper limits). `size` pixels a side.
core::Image ArticulatedView(const assets::ArticulatedAsset& asset, double open, int size);

// preview.png: closed and open from the front's two sides, and below the collision parts, each in
// a colour of its own.
core::Image ArticulatedPreview(const assets::ArticulatedAsset& asset);

}  // namespace simwright::pipeline
