#include "validation/photo_agreement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/float_image.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::validation {
namespace {

constexpr int kContrastSide = 256;      // pixels of the pictures whose contrast is compared
constexpr int kOutlineBorder = 3;       // pixels at the outline whose contrast does not count
constexpr double kLeastContrast = 2.5;  // grey levels of 255, of an object that is not plain

double Grey(const std::uint8_t* pixel) {
  return 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
}

// Returns the root mean square difference between pixels and their right and lower neighbours where
// all pixels within the border are opaque; 0 if there are none. RGBA.
double NeighbourContrast(const core::Image& image) {
  std::vector<char> inside(static_cast<size_t>(image.width) * image.height, 0);
  for (int y = kOutlineBorder; y + kOutlineBorder < image.height; ++y) {
    for (int x = kOutlineBorder; x + kOutlineBorder < image.width; ++x) {
      bool opaque = true;
      for (const int d : {-kOutlineBorder, 0, kOutlineBorder}) {
        opaque &= image.At(x + d, y)[3] > 250 && image.At(x, y + d)[3] > 250;
      }
      inside[static_cast<size_t>(y) * image.width + x] = opaque;
    }
  }
  double sum = 0.0;
  long count = 0;
  for (int y = 0; y + 1 < image.height; ++y) {
    for (int x = 0; x + 1 < image.width; ++x) {
      const size_t at = static_cast<size_t>(y) * image.width + x;
      if (!inside[at] || !inside[at + 1] || !inside[at + image.width]) continue;
      const double here = Grey(image.At(x, y));
      const double right = Grey(image.At(x + 1, y)) - here, down = Grey(image.At(x, y + 1)) - here;
      sum += right * right + down * down;
      count += 2;
    }
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0.0;
}

// Returns the part of an image that alpha fills, scaled to the side in which contrast is compared.
core::Image Opaque(const core::Image& image) {
  int left = image.width, top = image.height, right = 0, bottom = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (image.At(x, y)[3] < 128) continue;
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  }
  if (right <= left) return core::Image(1, 1, 4);
  core::Image part(right - left, bottom - top, 4);
  for (int y = 0; y < part.height; ++y) {
    std::copy_n(image.At(left, top + y), 4 * part.width, part.At(0, y));
  }
  const double scale = static_cast<double>(kContrastSide) / std::max(part.width, part.height);
  if (scale >= 1.0) return part;
  return core::Resize(part, std::max(1, static_cast<int>(std::lround(scale * part.width))),
                      std::max(1, static_cast<int>(std::lround(scale * part.height))));
}

double OutlineIou(const core::Image& a, const core::Image& b) {
  double both = 0.0, either = 0.0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      const double in_a = a.At(x, y)[3], in_b = b.At(x, y)[3];
      both += std::min(in_a, in_b);
      either += std::max(in_a, in_b);
    }
  }
  return either > 0.0 ? both / either : 0.0;
}

core::Camera Behind(core::Camera camera, const Eigen::Vector3d& middle) {
  const Eigen::Isometry3d turn = Eigen::Translation3d(middle) *
                                 Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()) *
                                 Eigen::Translation3d(-middle);
  camera.world_from_camera = turn * camera.world_from_camera;
  return camera;
}

}  // namespace

PhotoAgreement CompareWithPhoto(const core::TexturedMesh& mesh, const AssetPhoto& photo) {
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.lit = false;
  const core::Image front = render::RenderForward(scene, photo.camera, options).color;
  PhotoAgreement agreement;
  agreement.outline_iou = OutlineIou(front, photo.cut_out);
  const double contrast = NeighbourContrast(Opaque(photo.cut_out));
  agreement.textured = contrast >= kLeastContrast;
  if (!agreement.textured) return agreement;
  const core::Camera behind = Behind(photo.camera, core::Bounds(mesh.mesh).center());
  const core::Image back = render::RenderForward(scene, behind, options).color;
  const double front_contrast = NeighbourContrast(Opaque(front));
  agreement.texture_contrast = front_contrast / contrast;
  agreement.hidden_contrast =
      front_contrast > 0.0 ? NeighbourContrast(Opaque(back)) / front_contrast : 1.0;
  return agreement;
}

}  // namespace simwright::validation
