#pragma once

#include <filesystem>

#include "scene/palette.h"

namespace simwright::scene {

// A palette of the asset folders in `folder` (docs/formats.md), rigid ones: "teapot_3" stands for
// the slot "teapot", and of several for one slot the first by name does. Whatever else lies there
// is passed over. Throws core::Error where the folder cannot be read, an asset is damaged, or none
// is there.
Palette ReadPalette(const std::filesystem::path& folder);

}  // namespace simwright::scene
