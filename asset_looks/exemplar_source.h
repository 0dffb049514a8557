#pragma once

#include <filesystem>

#include "core/finding.h"
#include "texture/painting/exemplar_generator.h"

namespace simwright::asset_looks {

// Returns a swatch of the material in a photo: the largest square inside the object that stands out
// from the background, or inside the whole picture where none does, without its shading. An object
// in the photo is taken to be as large as `object_length` (m), and so is a whole picture. Findings
// say what was taken. Throws core::Error for an unreadable or too small picture.
texture::Swatch SwatchFromPhoto(const std::filesystem::path& photo, double object_length,
                                core::Findings* findings);

// Returns a swatch of another asset's surface in its true size: the largest square of the four
// sides and the top, preferring sides that face the camera. Throws core::Error if the folder holds
// no asset.
texture::Swatch SwatchFromAsset(const std::filesystem::path& folder, core::Findings* findings);

}  // namespace simwright::asset_looks
