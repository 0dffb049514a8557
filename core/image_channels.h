#pragma once

#include "core/image.h"

namespace simwright::core {

// Returns the image with three channels: grey is repeated, and a transparent image lies over white.
Image InRgb(const Image& image);

}  // namespace simwright::core
