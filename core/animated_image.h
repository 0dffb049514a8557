#pragma once

#include <string>
#include <string_view>

#include "core/image.h"

namespace simwright::core {

// The first frame of a GIF or of an animated WebP, as it is shown: on its canvas, RGBA.
// Neither is read by OpenCV 4.6. Throws core::Error, naming `where`, when damaged.
Image DecodeFirstGifFrame(std::string_view bytes, const std::string& where);
Image DecodeFirstWebpFrame(std::string_view bytes, const std::string& where);

}  // namespace simwright::core
