#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/camera.h"
#include "core/image.h"
#include "core/random.h"
#include "library/rigid/rigid_kinds.h"
#include "render/forward.h"
#include "render/surface_look.h"
#include "texture/photo_projection.h"

namespace simwright::texture {

// A photo of an object whose albedo is known.
struct LitPhoto {
  core::TriangleMesh mesh;
  PhotoView view;
  std::vector<Eigen::Vector3f> albedo;  // (width x height) linear RGB; 0 beside the object
};

// Draws a photo of an object of the library: random colours, half of them with a checker, stripes,
// noise or planks of another colour; a key light and often a fill light, distant, with cast
// shadows; ambient light, brighter above, with ambient occlusion; highlights (Blinn-Phong); noise,
// and a clipped exposure. None of this uses spherical harmonics. 288 x 288 pixels.
class LitPhotoStudio {
 public:
  LitPhotoStudio(const std::string& kind, std::uint64_t seed)
      : rng_(core::StreamRng(seed, 100 * kind.size() + static_cast<std::uint64_t>(kind[0]))) {
    library::RigidObject object = library::MakeRigidObject(*library::FindRigidKind(kind), seed);
    visual_ = object.visual;
    photo_.mesh = visual_.mesh;
    scene_.Add(&visual_);
    scene_.Commit();
    size_ = static_cast<float>(core::Bounds(visual_.mesh).diagonal().norm());
    for (std::size_t m = 0; m < visual_.materials.size() + 1; ++m) {
      colors_.push_back(RandomColor());
    }
    look_.pattern_color = colors_.back();
    if (core::Uniform(rng_) < 0.5) {
      constexpr render::Pattern kPatterns[] = {render::Pattern::kChecker, render::Pattern::kStripes,
                                               render::Pattern::kNoise, render::Pattern::kPlanks};
      look_.pattern = kPatterns[core::UniformIndex(rng_, 4)];
      look_.pattern_size = size_ * static_cast<float>(core::Uniform(rng_, 0.1, 0.25));
      look_.pattern_seed = static_cast<std::uint32_t>(seed);
    }
  }

  LitPhoto Take() {
    constexpr int kSide = 288;
    const double fov = 0.5;
    core::Camera camera = core::OrbitCamera(
        core::Bounds(visual_.mesh).center(), 0.55 * size_ / std::sin(0.5 * fov),
        core::Uniform(rng_, 0.15, 0.8), core::Uniform(rng_, -3.1, 3.1), fov, kSide, kSide);
    render::ForwardBuffers buffers = render::RenderForward(scene_, camera, {});
    DrawLights(camera);
    photo_.albedo.assign(buffers.depth.size(), Eigen::Vector3f::Zero());
    std::vector<Eigen::Vector3f> radiance(buffers.depth.size(), Eigen::Vector3f::Zero());
    std::vector<float> levels;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const std::size_t at = buffers.Index(x, y);
        if (buffers.label[at] < 0) continue;
        const Eigen::Vector3f ray = camera.Ray({x + 0.5, y + 0.5}).cast<float>();
        const Eigen::Vector3f point = camera.position().cast<float>() + buffers.depth[at] * ray;
        photo_.albedo[at] = AlbedoAt(point, buffers.triangle[at]);
        radiance[at] = Radiance(point, buffers.normal[at], -ray.normalized(), photo_.albedo[at]);
        levels.push_back(radiance[at].maxCoeff());
      }
    }
    std::sort(levels.begin(), levels.end());
    const float bright = levels[levels.size() * 98 / 100];
    const float exposure = static_cast<float>(core::Uniform(rng_, 0.75, 1.1)) / bright;
    photo_.view = {camera, core::Image(kSide, kSide, 3, 250), core::Image(kSide, kSide, 1)};
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const std::size_t at = buffers.Index(x, y);
        if (buffers.label[at] < 0) continue;
        photo_.view.alpha.At(x, y)[0] = 255;
        for (int c = 0; c < 3; ++c) {
          const float noisy =
              exposure * radiance[at][c] + 0.004f * static_cast<float>(core::Normal(rng_));
          photo_.view.photo.At(x, y)[c] = static_cast<std::uint8_t>(
              std::lround(255.0f * render::SrgbFromLinear(std::clamp(noisy, 0.0f, 1.0f))));
        }
      }
    }
    return photo_;
  }

 private:
  struct DistantLight {
    Eigen::Vector3f direction, irradiance;
  };

  Eigen::Vector3f RandomColor() {
    Eigen::Vector3f color;  // sRGB
    for (int c = 0; c < 3; ++c) color[c] = static_cast<float>(core::Uniform(rng_, 0.15, 0.95));
    return color;
  }

  // A key light from the camera's side above, and mostly a weaker one from elsewhere.
  void DrawLights(const core::Camera& camera) {
    const Eigen::Matrix3f axes = camera.world_from_camera.linear().cast<float>();
    const auto draw = [&](double low, double high, double across) {
      const auto uniform = [&](double a, double b) {
        return static_cast<float>(core::Uniform(rng_, a, b));
      };
      const Eigen::Vector3f direction = uniform(-across, across) * axes.col(0) -
                                        uniform(0.2, 1.0) * axes.col(2) +
                                        uniform(0.2, 1.2) * Eigen::Vector3f::UnitZ();
      const float level = uniform(low, high);
      const Eigen::Vector3f tint(uniform(0.97, 1.03), 1.0f, uniform(0.94, 1.06));
      lights_.push_back({direction.normalized(), level * tint});
    };
    draw(0.6, 1.2, 1.3);
    if (core::Uniform(rng_) < 0.6) draw(0.1, 0.4, 2.0);
    ambient_ = static_cast<float>(core::Uniform(rng_, 0.25, 0.6));
    sky_ = static_cast<float>(core::Uniform(rng_, 0.0, 0.3));
    gloss_ = core::Uniform(rng_) < 0.7 ? static_cast<float>(core::Uniform(rng_, 0.05, 0.5)) : 0.0f;
    exponent_ = static_cast<float>(core::Uniform(rng_, 20.0, 120.0));
  }

  Eigen::Vector3f AlbedoAt(const Eigen::Vector3f& point, int triangle) const {
    const int material = visual_.triangle_material.empty()
                             ? 0
                             : visual_.triangle_material[static_cast<std::size_t>(triangle)];
    const float share =
        look_.pattern == render::Pattern::kNone ? 0.0f : render::PatternShare(look_, point);
    Eigen::Vector3f albedo;
    for (int c = 0; c < 3; ++c) {
      const float base = render::LinearFromSrgb(colors_[static_cast<std::size_t>(material)][c]);
      albedo[c] = base + share * (render::LinearFromSrgb(look_.pattern_color[c]) - base);
    }
    return albedo;
  }

  // The share of the sky that a point sees, from 24 random directions.
  float Openness(const Eigen::Vector3f& start, const Eigen::Vector3f& normal) {
    int open = 0;
    for (int i = 0; i < 24; ++i) {
      const Eigen::Vector3f direction =
          (normal + 0.999f * core::UniformDirection(rng_).cast<float>()).normalized();
      open += scene_.Occluded(start, direction, 0.0f, 2.0f * size_) ? 0 : 1;
    }
    return static_cast<float>(open) / 24.0f;
  }

  Eigen::Vector3f Radiance(const Eigen::Vector3f& point, const Eigen::Vector3f& normal,
                           const Eigen::Vector3f& to_camera, const Eigen::Vector3f& albedo) {
    const Eigen::Vector3f start = point + 2e-3f * size_ * normal;
    const float sky = ambient_ + sky_ * normal.z();
    Eigen::Vector3f radiance = std::max(0.02f, sky) * Openness(start, normal) * albedo;
    for (const DistantLight& light : lights_) {
      const float cosine = normal.dot(light.direction);
      if (cosine <= 0.0f) continue;
      if (scene_.Occluded(start, light.direction, 0.0f, 2.0f * size_)) continue;
      radiance += cosine * light.irradiance.cwiseProduct(albedo);
      const float half = std::max(0.0f, normal.dot((light.direction + to_camera).normalized()));
      radiance += gloss_ * std::pow(half, exponent_) * light.irradiance;
    }
    return radiance;
  }

  core::Rng rng_;
  core::TexturedMesh visual_;
  render::Scene scene_;
  float size_ = 1.0f;
  std::vector<Eigen::Vector3f> colors_;  // sRGB, by material, and the pattern's
  render::SurfaceLook look_;
  std::vector<DistantLight> lights_;
  float ambient_ = 0.4f, sky_ = 0.0f, gloss_ = 0.0f, exponent_ = 50.0f;
  LitPhoto photo_;
};

inline LitPhoto TakeLitPhoto(const std::string& kind, std::uint64_t seed) {
  return LitPhotoStudio(kind, seed).Take();
}

// Returns the root mean square error of a picture's colours (linear RGB) as albedo, over the
// object, after the gain of the picture that makes it least: the scale of light and albedo is
// unknown.
inline double AlbedoError(const LitPhoto& lit, const core::Image& picture) {
  double product = 0.0, square = 0.0, truth = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < lit.albedo.size(); ++i) {
    if (lit.view.alpha.pixels[i] == 0) continue;
    ++count;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value =
          render::LinearFromSrgb(static_cast<float>(picture.pixels[3 * i + c]) / 255.0f);
      const double wanted = lit.albedo[i][static_cast<Eigen::Index>(c)];
      product += value * wanted;
      square += value * value;
      truth += wanted * wanted;
    }
  }
  const double gain = square > 0.0 ? product / square : 0.0;
  const double sum = truth - 2.0 * gain * product + gain * gain * square;
  return std::sqrt(std::max(0.0, sum) /
                   (3.0 * static_cast<double>(std::max<std::size_t>(1, count))));
}

// Returns the mesh as a reconstruction knows it: lumps of 3 % of the diagonal along its normals.
inline core::TriangleMesh LumpyMesh(core::TriangleMesh mesh) {
  const std::vector<Eigen::Vector3d> normals = core::VertexNormals(mesh);
  const double size = core::Bounds(mesh).diagonal().norm();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = 2.0 * std::numbers::pi / (0.45 * size) * mesh.vertices[i];
    const double lump = std::sin(p.x() + 0.3) * std::sin(p.y() + 1.1) * std::sin(p.z() + 0.7);
    mesh.vertices[i] += 0.03 * size * lump * normals[i];
  }
  return mesh;
}

// The kinds on which the settings of delighting were chosen, and those that it is judged on.
inline const std::vector<std::string> kTunedKinds = {"bowl", "bottle", "book", "apple", "teapot"};
inline const std::vector<std::string> kHeldOutKinds = {"mug",  "vase", "plate", "box",
                                                       "ball", "pear", "can",   "jar"};

}  // namespace simwright::texture
