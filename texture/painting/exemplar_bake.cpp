#include "texture/painting/exemplar_bake.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "render/scene.h"
#include "texture/materials/noise.h"

namespace simwright::texture {
namespace {

constexpr int kLeastPlane = 64, kMostPlane = 1200;  // pixels per side
constexpr float kSharpness = 14.0f;                 // of the change from one plane to the next
constexpr float kIrregularity = 0.22f;

// The quilted pictures along x, y and z, and what maps a point to their pixels.
struct Planes {
  std::array<core::Image, 3> pictures;
  Eigen::Vector3f corner{0, 0, 0};
  float pixel = 1e-3f;  // m
  Eigen::Vector3f mean{0, 0, 0};

  Eigen::Vector3f At(int axis, const Eigen::Vector3f& point) const {
    const Eigen::Vector3f p = (point - corner) / pixel;
    const Eigen::Vector2f at = axis == 0   ? Eigen::Vector2f(p.y(), p.z())
                               : axis == 1 ? Eigen::Vector2f(p.x(), p.z())
                                           : Eigen::Vector2f(p.x(), p.y());
    const core::Image& picture = pictures[static_cast<std::size_t>(axis)];
    const Eigen::Vector2f uv(at.x() / static_cast<float>(picture.width),
                             at.y() / static_cast<float>(picture.height));
    return core::SampleTexture(picture, uv).head<3>();
  }
};

// The mean spacing of the texels, m.
double TexelSpacing(const core::TriangleMesh& mesh, const TexelMap& map) {
  double inside = 0.0;
  for (const std::uint8_t one : map.inside) inside += one;
  return std::sqrt(core::SurfaceArea(mesh) / std::max(1.0, inside));
}

Planes QuiltPlanes(const core::TriangleMesh& mesh, const TexelMap& map, const Swatch& swatch,
                   std::uint64_t seed) {
  const Eigen::AlignedBox3d box = core::Bounds(mesh);
  Planes planes;
  const double largest = std::max(1e-6, box.sizes().maxCoeff());
  const double pixel =
      std::max({swatch.pixel_size, 0.8 * TexelSpacing(mesh, map), largest / (kMostPlane - 4)});
  planes.pixel = static_cast<float>(pixel);
  planes.corner = (box.min() - Eigen::Vector3d::Constant(2.0 * pixel)).cast<float>();
  ExemplarGenerator generator(Rescaled(swatch, pixel));
  core::ParallelFor(3, [&](int axis) {
    const Eigen::Vector3d size = box.sizes() / pixel;
    const int wide = axis == 0 ? 1 : 0, tall = axis == 2 ? 1 : 2;
    const auto side = [](double pixels) {
      return std::clamp(static_cast<int>(std::ceil(pixels)) + 4, kLeastPlane, kMostPlane);
    };
    ImageRequest request;
    request.prompt = "exemplar";
    request.width = side(size[wide]);
    request.height = side(size[tall]);
    request.seed = 3 * seed + static_cast<std::uint64_t>(axis);
    planes.pictures[static_cast<std::size_t>(axis)] = generator.Generate(request);
  });
  double sum[3] = {0, 0, 0};
  for (std::size_t i = 0; i < swatch.picture.pixels.size(); ++i) {
    sum[i % 3] += swatch.picture.pixels[i];
  }
  const double count = static_cast<double>(swatch.picture.pixels.size()) / 3.0;
  for (int c = 0; c < 3; ++c) planes.mean[c] = static_cast<float>(sum[c] / (255.0 * count));
  return planes;
}

// The share of each plane, sum 1.
Eigen::Vector3f Shares(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, float scale,
                       std::uint32_t seed) {
  Eigen::Vector3f weight = normal.cwiseAbs();
  for (std::uint32_t k = 0; k < 3; ++k) {
    weight[k] += kIrregularity * FractalNoise(point / scale, 2, 0.0f, seed + 7 * k);
  }
  weight = weight.cwiseMax(1e-3f);
  weight /= weight.maxCoeff();
  weight = weight.array().pow(kSharpness);
  return weight / weight.sum();
}

}  // namespace

core::Image BakeExemplar(const core::TriangleMesh& mesh, const TexelMap& map, const Swatch& swatch,
                         std::uint64_t seed) {
  const Planes planes = QuiltPlanes(mesh, map, swatch, seed);
  core::TexturedMesh shape;
  shape.mesh = mesh;
  render::Scene scene;
  scene.Add(&shape);
  scene.Commit();
  const float scale = 0.12f * static_cast<float>(core::Bounds(mesh).diagonal().norm());
  core::Image texture(map.size, map.size, 3);
  core::ParallelFor(map.size, [&](int y) {
    for (int x = 0; x < map.size; ++x) {
      const std::size_t texel = map.Index(x, y);
      if (map.triangle[texel] < 0) continue;
      const Eigen::Vector3f point = map.Position(mesh, texel).cast<float>();
      const Eigen::Vector3f inside = map.OnTriangle(texel);
      render::Hit hit;
      hit.instance = 0;
      hit.triangle = map.triangle[texel];
      hit.u = inside[1];
      hit.v = inside[2];
      const Eigen::Vector3f share =
          Shares(point, scene.ShadingNormal(hit), scale, static_cast<std::uint32_t>(seed));
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        if (share[axis] > 1e-3f) sum += share[axis] * (planes.At(axis, point) - planes.mean);
      }
      // The sum of independent textures has less contrast than one of them (Heitz and Neyret,
      // "High-performance by-example noise using a histogram-preserving blending operator", 2018).
      const Eigen::Vector3f color = planes.mean + sum / share.norm();
      for (int c = 0; c < 3; ++c) {
        texture.pixels[3 * texel + c] =
            static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(color[c], 0.0f, 1.0f)));
      }
    }
  });
  FillBetweenCharts(map, kGutter, &texture);
  return texture;
}

}  // namespace simwright::texture
