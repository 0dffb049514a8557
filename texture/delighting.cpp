#include "texture/delighting.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/float_image.h"
#include "render/forward.h"
#include "texture/highlights.h"
#include "texture/shading_fit.h"

namespace simwright::texture {
namespace {

constexpr float kLeastFacing = 0.25f;  // flatter surfaces mix with the background
constexpr float kLeastMatte = 200.0f;
constexpr float kDarkest = 0.004f, kBrightest = 0.96f;  // linear: noise, and clipped highlights

core::Camera ScaledCamera(const core::Camera& camera, int longer_side) {
  const double scale =
      std::min(1.0, static_cast<double>(longer_side) / std::max(camera.width, camera.height));
  core::Camera small = camera;
  small.width = std::max(1, static_cast<int>(std::lround(camera.width * scale)));
  small.height = std::max(1, static_cast<int>(std::lround(camera.height * scale)));
  const double x = static_cast<double>(small.width) / camera.width;
  const double y = static_cast<double>(small.height) / camera.height;
  small.fx *= x, small.cx *= x, small.fy *= y, small.cy *= y;
  return small;
}

// Renders the share of the sky that each point sees, as grey values of 8 bits, linear.
core::FloatImage OpennessPicture(const core::TriangleMesh& mesh, const core::Camera& camera,
                                 const DelightingOptions& options) {
  core::TexturedMesh white;
  white.mesh = mesh;
  white.materials = {{"white", Eigen::Vector4f::Ones(), -1}};
  white.triangle_material.assign(mesh.triangles.size(), 0);
  render::Scene scene;
  scene.Add(&white);
  scene.Commit();
  render::ForwardOptions forward;
  forward.shaded = true;
  forward.cancellable = true;
  forward.light = render::SphericalHarmonicsLight::Uniform(1.0f);
  forward.occlusion_rays = options.occlusion_rays;
  forward.occlusion_reach = 1.0f;
  const core::Camera small = ScaledCamera(camera, options.occlusion_side);
  const render::ForwardBuffers buffers = render::RenderForward(scene, small, forward);
  core::FloatImage openness(small.width, small.height, 1, 1.0f);
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      if (buffers.color.At(x, y)[3] == 0) continue;
      // The mean of a window of 3 x 3 smooths the noise of the rays.
      float sum = 0.0f;
      int count = 0;
      for (int v = std::max(0, y - 1); v <= std::min(small.height - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(small.width - 1, x + 1); ++u) {
          if (buffers.color.At(u, v)[3] == 0) continue;
          sum += render::LinearFromSrgb(static_cast<float>(buffers.color.At(u, v)[0]) / 255.0f);
          ++count;
        }
      }
      *openness.At(x, y) = std::max(0.1f, sum / static_cast<float>(count));
    }
  }
  return openness;
}

Eigen::Vector3f LinearPixel(const core::Image& photo, int x, int y) {
  Eigen::Vector3f color;
  for (int c = 0; c < 3; ++c) {
    const std::uint8_t value = photo.At(x, y)[photo.channels < 3 ? 0 : c];
    color[c] = render::LinearFromSrgb(static_cast<float>(value) / 255.0f);
  }
  return color;
}

ObjectPixels PixelsOf(const core::TriangleMesh& mesh, const PhotoView& view,
                      const DelightingOptions& options) {
  core::TexturedMesh plain;
  plain.mesh = mesh;
  render::Scene scene;
  scene.Add(&plain);
  scene.Commit();
  render::ForwardOptions forward;
  forward.cancellable = true;
  const render::ForwardBuffers buffers = render::RenderForward(scene, view.camera, forward);
  const core::FloatImage openness = OpennessPicture(mesh, view.camera, options);
  ObjectPixels pixels;
  pixels.width = view.photo.width;
  pixels.height = view.photo.height;
  pixels.index.assign(static_cast<std::size_t>(pixels.width) * pixels.height, -1);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const std::size_t at = buffers.Index(x, y);
      if (buffers.label[at] < 0 || view.alpha.At(x, y)[0] < kLeastMatte) continue;
      const Eigen::Vector3d ray = view.camera.Ray({x + 0.5, y + 0.5}).normalized();
      pixels.index[at] = pixels.count();
      pixels.at.push_back(static_cast<int>(at));
      pixels.color.push_back(LinearPixel(view.photo, x, y));
      pixels.normal.push_back(buffers.normal[at]);
      pixels.facing.push_back(-buffers.normal[at].dot(ray.cast<float>()));
      pixels.openness.push_back(
          *openness.At(x * openness.width / pixels.width, y * openness.height / pixels.height));
    }
  }
  return pixels;
}

std::vector<char> UsablePixels(const ObjectPixels& pixels) {
  std::vector<char> usable(pixels.at.size());
  for (std::size_t i = 0; i < usable.size(); ++i) {
    usable[i] = pixels.facing[i] > kLeastFacing && pixels.color[i].maxCoeff() < kBrightest &&
                Brightness(pixels.color[i]) > kDarkest;
  }
  return usable;
}

void RequireUsable(const core::TriangleMesh& mesh, const PhotoView& view,
                   const DelightingOptions& options) {
  std::string fault;
  if (!options.IsValid(&fault)) throw core::Error(fault, "the options of delighting");
  if (mesh.triangles.empty()) throw core::Error("delighting needs a mesh with faces");
  const auto fits = [&](const core::Image& image) {
    return image.width == view.camera.width && image.height == view.camera.height;
  };
  if (!fits(view.photo) || !fits(view.alpha) || view.alpha.channels != 1) {
    throw core::Error("photo, matte and camera must have one size, and the matte one channel");
  }
}

// Dims the albedo if more than a fiftieth of it would be brighter than white.
void KeepBelowWhite(std::vector<Eigen::Vector3f>* albedo) {
  std::vector<float> levels;
  for (const Eigen::Vector3f& color : *albedo) levels.push_back(color.maxCoeff());
  const auto high = levels.begin() + static_cast<long>(levels.size() * 98 / 100);
  std::nth_element(levels.begin(), high, levels.end());
  if (*high <= 1.0f) return;
  for (Eigen::Vector3f& color : *albedo) color /= *high;
}

// Writes the albedo into the picture; brighter than white is cut off.
void StoreAlbedo(const ObjectPixels& pixels, const std::vector<Eigen::Vector3f>& albedo,
                 core::Image* picture) {
  for (std::size_t i = 0; i < albedo.size(); ++i) {
    std::uint8_t* pixel = picture->At(pixels.at[i] % pixels.width, pixels.at[i] / pixels.width);
    for (int c = 0; c < 3; ++c) {
      const float srgb = render::SrgbFromLinear(std::clamp(albedo[i][c], 0.0f, 1.0f));
      pixel[c] = static_cast<std::uint8_t>(std::lround(255.0f * srgb));
    }
  }
}

}  // namespace

bool DelightingOptions::IsValid(std::string* error) const {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  const bool valid = pairs >= 100 && pairs <= 10'000'000 && positive(chroma_scale) &&
                     positive(edge_scale) && positive(band1_ridge) && positive(band2_ridge) &&
                     least_shading > 0.0 && least_shading <= 1.0 && occlusion_rays >= 1 &&
                     occlusion_side >= 16;
  if (!valid && error != nullptr)
    *error = "a number of pairs, scale, ridge or rays is out of range";
  return valid;
}

DelitPhoto DelightPhoto(const core::TriangleMesh& mesh, const PhotoView& view,
                        const DelightingOptions& options) {
  RequireUsable(mesh, view, options);
  const ObjectPixels pixels = PixelsOf(mesh, view, options);
  if (pixels.count() == 0) throw core::Error("the camera sees nothing of the mesh in the matte");
  std::vector<char> usable = UsablePixels(pixels);
  const auto least = static_cast<float>(options.least_shading);
  DelitPhoto delit;
  std::vector<Eigen::Vector3f> albedo;
  std::vector<char> replaced(pixels.at.size(), 0);
  Eigen::Matrix<float, 9, 1> light;
  std::vector<float> shading;
  const Eigen::Vector3f viewer = -view.camera.world_from_camera.linear().col(2).cast<float>();
  // The second fit leaves the highlights of the first one out.
  for (int round = 0; round < (options.remove_highlights ? 2 : 1); ++round) {
    light = FitGreyLight(pixels, usable, options);
    shading = ShadingOf(pixels, light, least);
    albedo = pixels.color;
    for (std::size_t i = 0; i < albedo.size(); ++i) albedo[i] /= shading[i];
    if (!options.remove_highlights) break;
    replaced = ReplaceHighlights(pixels, light, viewer, &albedo);
    for (std::size_t i = 0; i < usable.size(); ++i) usable[i] = usable[i] && !replaced[i];
  }
  delit.light.radiance = light * Eigen::RowVector3f::Ones();
  delit.highlights =
      static_cast<double>(std::count(replaced.begin(), replaced.end(), 1)) / pixels.count();
  std::sort(shading.begin(), shading.end());
  const auto quantile = [&](double q) {
    return shading[static_cast<std::size_t>(q * static_cast<double>(shading.size() - 1))];
  };
  delit.contrast = quantile(0.95) / quantile(0.05);
  delit.albedo = core::Image(pixels.width, pixels.height, 3);
  for (int y = 0; y < pixels.height; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        delit.albedo.At(x, y)[c] = view.photo.At(x, y)[view.photo.channels < 3 ? 0 : c];
      }
    }
  }
  KeepBelowWhite(&albedo);
  StoreAlbedo(pixels, albedo, &delit.albedo);
  return delit;
}

}  // namespace simwright::texture
