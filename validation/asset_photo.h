#pragma once

#include <filesystem>
#include <optional>

#include "core/camera.h"
#include "core/image.h"

namespace simwright::validation {

// The photo that an asset was reconstructed from.
struct AssetPhoto {
  core::Image cut_out;       // RGBA; alpha is the object
  core::Camera camera;       // link frame, m
  bool one_of_many = false;  // the shape comes from photos of all sides
};

// The file of the photo's camera in an asset's folder (camera_file.h), and its photo.
inline constexpr char kPhotoCameraFile[] = "camera.json";
inline constexpr char kCutOutFile[] = "matte.png";
// Is in the folder of an asset that was made from photos of all sides (docs/capture.md).
inline constexpr char kCaptureFile[] = "capture.json";

// Returns the photo of an asset folder; nothing if the folder has no camera file. Throws
// core::Error for damaged files.
std::optional<AssetPhoto> ReadAssetPhoto(const std::filesystem::path& folder);

}  // namespace simwright::validation
