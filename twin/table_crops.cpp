#include "twin/table_crops.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "asset_lift/priors/shape_example.h"
#include "core/error.h"
#include "library_fit/library_fit.h"
#include "twin/table_picture.h"

namespace simwright::twin {
namespace {

constexpr int kTries = 50;            // of tables and objects, until one is visible
constexpr int kLeastPixels = 80;      // of the object in the photo
constexpr int kMostSide = 160;        // pixels of the rendered crop
constexpr double kMargin = 1.3;       // of the rendered crop around the object's box
constexpr double kNarrowest = 480.0;  // pixels, of the photo
constexpr double kWidest = 1600.0;

// Returns the camera of the square crop around an object's box, as fine as the photo if it is not
// too large.
core::Camera CropCamera(const core::Camera& photo, const Eigen::AlignedBox2d& box) {
  const double extent = std::max(8.0, kMargin * box.sizes().maxCoeff());
  const int side = std::min(kMostSide, static_cast<int>(std::ceil(extent)));
  const double scale = side / extent;
  const Eigen::Vector2d corner = box.center() - Eigen::Vector2d::Constant(0.5 * extent);
  core::Camera crop = photo;
  crop.width = crop.height = side;
  crop.fx = photo.fx * scale;
  crop.fy = photo.fy * scale;
  crop.cx = (photo.cx - corner.x()) * scale;
  crop.cy = (photo.cy - corner.y()) * scale;
  return crop;
}

// Returns the direction from which a camera sees an object.
library_fit::FitView ViewOf(const TableObject& object, const core::Camera& camera) {
  const Eigen::AlignedBox3d bounds = core::Bounds(object.visual.mesh);
  const Eigen::Vector3d away =
      object.world_from_object.inverse() * camera.position() - bounds.center();
  library_fit::FitView view;
  view.azimuth = std::atan2(away.y(), away.x());
  view.elevation = std::asin(away.z() / away.norm());
  view.nearness = 0.5 * bounds.diagonal().norm() / away.norm();
  return view;
}

// Returns the object's mask in a rendered crop, without what lies outside of the photo.
core::Image MaskOf(const TablePicture& picture, int object, const core::Camera& crop,
                   const core::Camera& photo) {
  core::Image mask(picture.color.width, picture.color.height, 1);
  const double scale = photo.fx / crop.fx;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      const double px = photo.cx + (x + 0.5 - crop.cx) * scale;
      const double py = photo.cy + (y + 0.5 - crop.cy) * scale;
      const bool inside = px >= 0.0 && py >= 0.0 && px < photo.width && py < photo.height;
      const int label = picture.label[static_cast<size_t>(y) * mask.width + x];
      *mask.At(x, y) = inside && label == object ? 255 : 0;
    }
  }
  return mask;
}

// Returns the crop of an object, or none if it is hidden.
std::optional<core::Image> VisiblePart(const TableSceneSources& sources, int object,
                                       std::uint64_t seed, TableScene* scene) {
  const core::Camera photo = scene->camera;
  const TableObject& of = scene->objects[static_cast<size_t>(object)];
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& vertex : of.visual.mesh.vertices) {
    const Eigen::Vector3d at = photo.Project(of.world_from_object * vertex);
    if (at.z() <= 1e-3) return std::nullopt;
    box.extend(Eigen::Vector2d(at.head<2>()));
  }
  const Eigen::AlignedBox2d seen = box.intersection(
      Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d(photo.width, photo.height)));
  if (seen.isEmpty() || seen.sizes().minCoeff() < 4.0) return std::nullopt;
  const core::Camera crop = CropCamera(photo, seen);
  scene->camera = crop;
  const TablePicture picture = RenderTable(*scene, sources, {2, 2, 1}, seed);
  scene->camera = photo;
  const core::Image mask = MaskOf(picture, object, crop, photo);
  const double area = std::pow(photo.fx / crop.fx, 2);
  const auto pixels = std::count(mask.pixels.begin(), mask.pixels.end(), 255);
  if (static_cast<double>(pixels) * area < kLeastPixels) return std::nullopt;
  return asset_lift::CropImage(picture.color, mask,
                               library_fit::FitPhotoOf(picture.color, mask).frame);
}

}  // namespace

library_fit::PriorExample TableCrop(const TableSceneSources& sources, std::uint64_t seed) {
  core::Rng rng = core::StreamRng(seed, 15485863);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    TableSceneOptions options;
    options.width =
        static_cast<int>(kNarrowest * std::pow(kWidest / kNarrowest, core::Uniform(rng)));
    options.height = options.width * 3 / 4;
    TableScene scene = SampleTableScene(sources, options, &rng);
    if (scene.objects.empty()) continue;
    const auto object = static_cast<size_t>(
        core::UniformIndex(rng, static_cast<std::int64_t>(scene.objects.size())));
    const TableObject& of = scene.objects[object];
    if (of.mesh >= 0) continue;
    const std::optional<core::Image> crop =
        VisiblePart(sources, static_cast<int>(object), rng(), &scene);
    if (!crop) continue;
    library_fit::PriorExample example =
        library_fit::LabelsOf(of.instance, ViewOf(of, scene.camera));
    example.picture = crop->pixels;
    return example;
  }
  throw core::Error("no table shows an object of the library");
}

}  // namespace simwright::twin
