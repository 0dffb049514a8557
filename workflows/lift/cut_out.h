#pragma once

#include "asset_lift/segmentation/segmentation.h"
#include "core/image.h"

namespace simwright::workflows {

// Returns the photo as RGBA, with `alpha` (1 channel, its size) as the fourth channel.
core::Image CutOut(const core::Image& photo, const core::Image& alpha);

// Returns the cut-out in the form that generators of meshes are trained on: a square whose side the
// longer side of the matte's bounding box fills to 85 %, with the object in its middle. Transparent
// pixels are white, so that a generator that ignores alpha sees a white background.
core::Image CenteredCutOut(const core::Image& photo, const asset_lift::Matte& matte);

}  // namespace simwright::workflows
