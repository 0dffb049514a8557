#pragma once

#include "capture/mat_evidence.h"
#include "core/float_image.h"
#include "core/image.h"

namespace simwright::capture {

// Returns the opacity (H x W x 1) of an object whose mask (H x W x 1, 0 or 1) is about right, on a
// mat. Near the mask's outline each pixel's colour is explained as a mixture of the mat's, in a
// soft shadow, and of a colour found further inside; the mixture's share is the opacity. Where
// neither explains the pixel better than the mask does, and beside the mat, the mask is kept.
// `photo`: RGB or RGBA. Throws core::Error if the sizes differ.
core::FloatImage MatteOnMat(const core::Image& photo, const MatEvidence& evidence,
                            const core::FloatImage& mask);

}  // namespace simwright::capture
