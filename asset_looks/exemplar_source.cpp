#include "asset_looks/exemplar_source.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "asset_lift/segmentation/segmentation.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/camera.h"
#include "core/error.h"
#include "core/image.h"
#include "render/forward.h"

namespace simwright::asset_looks {
namespace fs = std::filesystem;
namespace {

constexpr int kPhotoSide = 1400, kSwatchSide = 320, kViewSide = 480;         // pixels
constexpr double kElevation = 0.25, kTopElevation = 1.45, kViewAngle = 0.6;  // rad

std::string SquareSentence(int side, double scale, const std::string& where) {
  const int taken = static_cast<int>(side / scale);
  return "the exemplar is a square of " + std::to_string(taken) + " pixels " + where;
}

// Returns the mean cosine between the visible surface and the direction to the camera.
double MeanFacing(const render::ForwardBuffers& view, const core::Camera& camera) {
  double sum = 0.0, count = 0.0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const std::size_t at = view.Index(x, y);
      if (!(view.depth[at] > 0.0f)) continue;
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5}).normalized();
      sum += std::abs(ray.dot(view.normal[at].cast<double>()));
      ++count;
    }
  }
  return count > 0.0 ? sum / count : 0.0;
}

}  // namespace

texture::Swatch SwatchFromPhoto(const fs::path& photo, double object_length,
                                core::Findings* findings) {
  core::ImageReadOptions options;
  options.max_side = kPhotoSide;
  const core::Image picture = core::ReadImage(photo, options);
  core::Image mask;
  double length = std::max(picture.width, picture.height);
  std::string where = "of the whole picture, in which no single object stands out";
  try {
    const asset_lift::Matte matte = asset_lift::SegmentObject(picture, std::nullopt);
    mask = matte.alpha;
    length = std::max(matte.right - matte.left, matte.bottom - matte.top);
    where = "of the object in the photo (" + matte.method + ")";
  } catch (const core::Error&) {
    // A picture of the material itself.
  }
  double scale = 1.0;
  texture::Swatch swatch;
  core::Image square;
  try {
    square = texture::LargestSwatch(picture, mask, kSwatchSide, &scale);
  } catch (const core::Error&) {
    if (mask.empty()) throw;
    square = texture::LargestSwatch(picture, {}, kSwatchSide, &scale);
    length = std::max(picture.width, picture.height);
    where = "of the whole picture, since its object is too thin";
  }
  swatch.picture = texture::WithoutShading(square);
  swatch.pixel_size = object_length / length / scale;
  findings->push_back({"texture-exemplar", core::Severity::kInfo, photo.filename().string(),
                       SquareSentence(square.width, scale, where) +
                           "; its true size is not known, and what it shows is taken to be as long "
                           "as the asset",
                       swatch.pixel_size * square.width});
  return swatch;
}

texture::Swatch SwatchFromAsset(const fs::path& folder, core::Findings* findings) {
  if (!assets::IsAssetFolder(folder)) {
    throw core::Error("holds no asset.json", folder.string(), "give the folder of an asset");
  }
  const core::TexturedMesh visual =
      assets::IsArticulatedAssetFolder(folder)
          ? assets::VisualAtPositions(assets::ReadArticulatedAsset(folder))
          : assets::ReadAsset(folder).visual;
  render::Scene scene;
  scene.Add(&visual);
  scene.Commit();
  const Eigen::AlignedBox3d box = core::Bounds(visual.mesh);
  const double distance = 0.55 * box.diagonal().norm() / std::sin(0.5 * kViewAngle);
  render::ForwardOptions options;
  options.shaded = true;
  options.lit = false;
  options.samples_per_side = 3;
  texture::Swatch best;
  double best_score = 0.0, taken = 0.0;
  for (int side = 0; side < 5; ++side) {
    const core::Camera camera =
        core::OrbitCamera(box.center(), distance, side < 4 ? kElevation : kTopElevation,
                          M_PI + 0.5 * M_PI * (side % 4), kViewAngle, kViewSide, kViewSide);
    const render::ForwardBuffers view = render::RenderForward(scene, camera, options);
    core::Image mask(view.width, view.height, 1);
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) *mask.At(x, y) = view.color.At(x, y)[3];
    }
    try {
      double scale = 1.0;
      const core::Image square = texture::LargestSwatch(view.color, mask, kSwatchSide, &scale);
      // Patterns of surfaces that the camera does not face are squeezed.
      const double facing = MeanFacing(view, camera);
      const double score = square.width / scale * facing * facing;
      if (score <= best_score) continue;
      best_score = score;
      taken = square.width / scale;
      best.picture = square;
      best.pixel_size = distance / camera.fx / scale;
    } catch (const core::Error&) {
      continue;  // too thin from this side
    }
  }
  if (best.picture.empty()) {
    throw core::Error("is too thin to take a square of its surface", folder.string(),
                      "give another asset or a photo of the material");
  }
  findings->push_back({"texture-exemplar", core::Severity::kInfo, folder.filename().string(),
                       SquareSentence(best.picture.width, best.picture.width / taken,
                                      "of a rendering of the asset, in its true size"),
                       best.pixel_size * best.picture.width});
  return best;
}

}  // namespace simwright::asset_looks
