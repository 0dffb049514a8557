#pragma once

#include <Eigen/Geometry>

#include "core/image.h"

namespace simwright::asset_lift {

// Segments the object in a box of a photo (RGB): GrabCut (Rother et al. 2004) with the pixels
// outside of the box as background, at most `working_side` pixels over the box's longer side.
// Returns the mask (1 channel, the photo's size, 255 inside); where GrabCut finds nearly nothing,
// the ellipse in the box. `box`: pixels, clipped to the photo. Throws core::Error for a box with
// less than 4 pixels a side inside of the photo.
core::Image BoxMatte(const core::Image& photo, const Eigen::AlignedBox2d& box,
                     int working_side = 240);

}  // namespace simwright::asset_lift
