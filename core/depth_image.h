#pragma once

#include <filesystem>

#include "core/float_image.h"

namespace simwright::core {

// Reads a depth image, one channel of 16 bits as depth cameras write it (PNG or TIFF): returns
// metres, `unit` (m) times each value, and 0 where nothing was measured. Throws core::Error for a
// file that is no such image: damaged, in colour, or of 8 bits, too coarse for lengths.
FloatImage ReadDepthImage(const std::filesystem::path& path, double unit = 1e-3);

}  // namespace simwright::core
