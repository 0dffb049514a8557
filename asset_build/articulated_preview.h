#pragma once

#include "assets/articulated_asset.h"
#include "core/image.h"

namespace simwright::asset_build {

// Renders the asset from the front, slightly right and above, with all joints at the fraction
// `open` of their ranges (0: at zero, closed; 1: at the upper limits). The image is square, `size`
// pixels a side.
core::Image ArticulatedView(const assets::ArticulatedAsset& asset, double open, int size);

// Renders preview.png: the asset closed and open, from the front left and the front right, and
// below that the collision parts, each in its own colour.
core::Image ArticulatedPreview(const assets::ArticulatedAsset& asset);

}  // namespace simwright::asset_build
