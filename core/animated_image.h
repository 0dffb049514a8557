#pragma once

#include <string>
#include <string_view>

#include "core/image.h"

namespace simwright::core {

// Decodes the first frame of a GIF or of an animated WebP, composed on its canvas, as RGBA. OpenCV
// 4.6 reads neither format. Throws core::Error, naming `where`, for damaged data.
Image DecodeFirstGifFrame(std::string_view bytes, const std::string& where);
Image DecodeFirstWebpFrame(std::string_view bytes, const std::string& where);

}  // namespace simwright::core
