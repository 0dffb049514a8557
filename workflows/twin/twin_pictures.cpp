#include "workflows/twin/twin_pictures.h"

#include <cmath>
#include <deque>

#include "assets/articulated_asset.h"
#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr float kPhotoShare = 0.35f;   // of the photo's brightness behind the twin
constexpr int kAboveSide = 480;        // pixels
constexpr double kAboveMargin = 0.08;  // m around the objects

// The visual mesh of an object as the photo shows it, in the asset's frame.
core::TexturedMesh VisualOf(const fs::path& asset, const TwinObject& object) {
  if (!object.articulated) return assets::ReadAsset(asset).visual;
  return assets::VisualAtPositions(assets::ReadArticulatedAsset(asset), object.joints);
}

core::Image OverGrey(const core::Image& rgba, std::uint8_t grey) {
  core::Image rgb(rgba.width, rgba.height, 3);
  for (size_t i = 0; i < rgb.pixels.size() / 3; ++i) {
    const float share = rgba.pixels[4 * i + 3] / 255.0f;
    for (size_t c = 0; c < 3; ++c) {
      const float value = share * rgba.pixels[4 * i + c] + (1.0f - share) * grey;
      rgb.pixels[3 * i + c] = static_cast<std::uint8_t>(std::lround(value));
    }
  }
  return rgb;
}

core::Image OverPhoto(const core::Image& rgba, const core::Image& photo) {
  core::Image rgb(photo.width, photo.height, 3);
  for (size_t i = 0; i < rgb.pixels.size() / 3; ++i) {
    const float share = rgba.pixels[4 * i + 3] / 255.0f;
    for (size_t c = 0; c < 3; ++c) {
      const float behind = kPhotoShare * photo.pixels[3 * i + c];
      rgb.pixels[3 * i + c] = static_cast<std::uint8_t>(
          std::lround(share * rgba.pixels[4 * i + c] + (1.0f - share) * behind));
    }
  }
  return rgb;
}

// A camera far above that sees all objects, x to the right and y upwards.
core::Camera CameraAbove(const render::Scene& scene) {
  const Eigen::AlignedBox3d box = scene.bounds().cast<double>();
  const double side = box.sizes().head<2>().maxCoeff() + 2.0 * kAboveMargin;
  constexpr double kDistance = 10.0;  // in sides
  core::Camera camera;
  camera.width = camera.height = kAboveSide;
  camera.fx = camera.fy = kDistance * kAboveSide;
  camera.cx = camera.cy = 0.5 * kAboveSide;
  camera.world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal().toDenseMatrix();
  camera.world_from_camera.translation() =
      box.center() + kDistance * side * Eigen::Vector3d::UnitZ();
  return camera;
}

}  // namespace

TwinPictures RenderTwin(const TwinRecord& record, const fs::path& assets,
                        const core::Image& photo) {
  std::deque<core::TexturedMesh> meshes;
  render::Scene scene;
  for (const TwinObject& object : record.objects) {
    meshes.push_back(VisualOf(assets / object.name, object));
    scene.Add(&meshes.back(), object.world_from_object);
  }
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.lit = false;  // the photo's colours contain its light
  const core::Image seen = render::RenderForward(scene, record.camera, options).color;
  TwinPictures pictures;
  pictures.rendered = OverGrey(seen, 255);
  pictures.overlay = OverPhoto(seen, photo);
  pictures.above = OverGrey(render::RenderForward(scene, CameraAbove(scene), options).color, 255);
  return pictures;
}

}  // namespace simwright::workflows
