#include "workflows/twin/twin_photo.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "core/depth_image.h"
#include "core/error.h"
#include "core/files.h"
#include "core/image_channels.h"
#include "twin/camera_intrinsics.h"
#include "twin/photo_check.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr double kFlagDegree = M_PI / 180.0;
constexpr int kLongerSide = 960;        // pixels of the photo as used
constexpr double kFilmWidth = 36.0;     // mm, of EXIF's equivalent focal length
constexpr double kExifError = 0.03;     // of the logarithm of such a focal length
constexpr double kUsualFocal = 0.85;    // over the width, of 61 degrees
constexpr double kSteepDegrees = 75.0;  // beyond, the picture may be one of a wall
constexpr std::uint64_t kMostPhotoBytes = 256u << 20;

// Reads what is known of the lens: the calibration, --fov or EXIF.
void ReadLens(const TwinRequest& request, const std::string& bytes, TwinPhoto* photo,
              core::Findings* findings) {
  if (!request.intrinsics.empty()) {
    if (request.camera.fov > 0.0) {
      throw core::Error("--camera and --fov both state the field of view",
                        request.intrinsics.string(), "give one of them");
    }
    const twin::CameraIntrinsics lens =
        twin::ReadCameraIntrinsics(request.intrinsics, photo->width, photo->height);
    photo->focal = lens.focal;
    photo->principal = lens.principal;
    findings->insert(findings->end(), lens.findings.begin(), lens.findings.end());
  } else if (request.camera.fov > 0.0) {
    photo->focal = 0.5 / std::tan(0.5 * request.camera.fov * kFlagDegree);
  } else if (const double film = core::ExifFocalLength35mm(bytes); film > 0.0) {
    // The equivalent refers to the longer side.
    photo->focal = film / kFilmWidth * std::max(photo->width, photo->height) / photo->width;
    photo->log_focal_error = kExifError;
  }
}

void ReadDepth(const TwinRequest& request, const fs::path& depth, TwinPhoto* photo,
               core::Findings* findings) {
  if (request.camera.elevation > 0.0 || request.camera.height > 0.0 || request.camera.upright) {
    throw core::Error("the depth tells the camera's elevation, roll and height", depth.string(),
                      "leave out what states them again");
  }
  photo->depth = twin::DepthOfPhoto(core::ReadDepthImage(depth, request.depth_unit),
                                    photo->rgb.width, photo->rgb.height, depth.string());
  if (photo->focal <= 0.0) {
    photo->focal = kUsualFocal;
    findings->push_back({"twin-fov-guessed", core::Severity::kWarning, "",
                         "the field of view is not known; 61 degrees are taken, and lengths across "
                         "the picture are as wrong as that",
                         61.0, "give --camera or --fov"});
  }
  twin::TableCamera lens;
  lens.focal = photo->focal;
  lens.principal = photo->principal;
  photo->plane = twin::FitTablePlane(photo->depth, lens, request.seed, depth.string());
  const double degrees = photo->plane->camera.elevation / kFlagDegree;
  if (degrees > kSteepDegrees) {
    findings->push_back({"twin-steep", core::Severity::kWarning, "",
                         "the camera looks nearly straight onto the plane: is it a table, not a "
                         "wall?",
                         degrees, "take the photo of a table from 15 to 65 degrees above"});
  }
}

}  // namespace

TwinPhoto ReadTwinPhoto(const TwinRequest& request, const TwinView& view,
                        core::Findings* findings) {
  TwinPhoto photo;
  const std::string bytes = core::ReadFile(view.photo, kMostPhotoBytes);
  const core::Image whole = core::DecodeImage(bytes, view.photo.string());
  photo.width = whole.width;
  photo.height = whole.height;
  const double scale =
      std::min(1.0, static_cast<double>(kLongerSide) / std::max(whole.width, whole.height));
  photo.rgb = core::InRgb(whole);
  if (scale < 1.0) {
    photo.rgb = core::Resize(photo.rgb, static_cast<int>(std::lround(scale * whole.width)),
                             static_cast<int>(std::lround(scale * whole.height)));
  }
  if (photo.rgb.width < 64 || photo.rgb.height < 64) {
    throw core::Error("the photo has less than 64 pixels a side", view.photo.string());
  }
  const core::Findings light = twin::CheckTablePhoto(photo.rgb, view.photo.string());
  findings->insert(findings->end(), light.begin(), light.end());
  ReadLens(request, bytes, &photo, findings);
  if (!view.depth.empty()) ReadDepth(request, view.depth, &photo, findings);
  return photo;
}

}  // namespace simwright::workflows
