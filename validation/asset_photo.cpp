#include "validation/asset_photo.h"

#include "assets/camera_file.h"
#include "core/error.h"

namespace simwright::validation {
namespace fs = std::filesystem;

std::optional<AssetPhoto> ReadAssetPhoto(const fs::path& folder) {
  if (!fs::exists(folder / kPhotoCameraFile)) return {};
  const auto cameras = assets::ReadCameraFile(folder / kPhotoCameraFile);
  const auto found = cameras.find(kCutOutFile);
  if (found == cameras.end()) {
    throw core::Error(std::string("has no camera of ") + kCutOutFile, folder / kPhotoCameraFile);
  }
  AssetPhoto photo{core::ReadImage(folder / kCutOutFile), found->second,
                   fs::exists(folder / kCaptureFile)};
  if (photo.cut_out.channels != 4 || photo.cut_out.width != photo.camera.width ||
      photo.cut_out.height != photo.camera.height) {
    throw core::Error("is no RGBA image of its camera's size", folder / kCutOutFile);
  }
  return photo;
}

}  // namespace simwright::validation
