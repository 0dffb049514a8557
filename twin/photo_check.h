#pragma once

#include <string>

#include "core/finding.h"
#include "core/image.h"

namespace simwright::twin {

// Returns the findings about the light of a photo (RGB): "twin-dark" below a mean luminance of 45
// of 255, "twin-overexposed" where more than half of the pixels are white. Throws core::Error,
// naming `where`, for a photo in which nothing can be seen: a mean luminance below 14, or one
// colour all over.
core::Findings CheckTablePhoto(const core::Image& photo, const std::string& where);

}  // namespace simwright::twin
