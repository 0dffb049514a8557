#pragma once

#include "core/image.h"

namespace simwright::asset_lift {

// Moves the outline of a rough mask (1 channel, the photo's size, 255 inside) to the edges of the
// photo (RGB) by GrabCut (Rother et al. 2004): within a band around the outline, pixels go to the
// object or to its surroundings by their colours. Pixels of `others` (as the mask) belong to other
// objects. Returns `mask` itself if it is empty, or if GrabCut's answer has less than half of the
// union in common with it. `working_side`: pixels over the longer side of the object, at most.
core::Image RefinedMask(const core::Image& photo, const core::Image& mask,
                        const core::Image& others, int working_side = 160);

}  // namespace simwright::asset_lift
