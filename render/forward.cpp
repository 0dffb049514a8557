#include "render/forward.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "render/reflection.h"

namespace simwright::render {
namespace {

// Hashes `x` (Wellons, "lowbias32"), so that sub-pixel directions differ between neighbours.
std::uint32_t MixedVertices(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

class Shader {
 public:
  Shader(const Scene& scene, const ForwardOptions& options) : scene_(scene), options_(options) {
    const Eigen::AlignedBox3f box = scene.bounds();
    reach_ = box.isEmpty() ? 0.0f : options.occlusion_reach * box.diagonal().norm();
    if (scene.HasLooks()) specular_.emplace(options.light);
  }

  // The last albedo that was made linear: neighbouring hits often have the same.
  struct LastAlbedo {
    Eigen::Vector3f srgb = Eigen::Vector3f::Zero(), linear = Eigen::Vector3f::Zero();
  };

  // A hit of a ray (its direction, world), whose shading normal faces the camera.
  struct Seen {
    const Hit& hit;
    const Eigen::Vector3f &ray, &point, &normal;
  };

  // Returns the linear RGB of a hit.
  Eigen::Vector3f Color(const Seen& seen, size_t pixel, int sample, LastAlbedo* last) const {
    const auto& [hit, ray, point, normal] = seen;
    const Eigen::Vector3f albedo = scene_.Albedo(hit).head<3>();
    if (albedo != last->srgb) {
      last->srgb = albedo;
      for (int c = 0; c < 3; ++c) last->linear[c] = LinearFromSrgb(albedo[c]);
    }
    Eigen::Vector3f color = last->linear;
    if (!options_.lit) return color;
    if (specular_ && scene_.look(hit.instance) != nullptr) {
      return LookColor(seen, color, pixel, sample);
    }
    color = color.cwiseProduct(options_.light.Shade(normal));
    if (options_.occlusion_rays > 0) color *= Openness(point, normal, pixel, sample);
    return color;
  }

 private:
  // Returns the linear RGB of a surface with a look: its diffuse part and its reflection.
  Eigen::Vector3f LookColor(const Seen& seen, const Eigen::Vector3f& albedo, size_t pixel,
                            int sample) const {
    Eigen::Vector3f normal;
    const SurfaceReflection surface = scene_.ReflectionAt(seen.hit, seen.normal, &normal);
    const bool occluded = options_.occlusion_rays > 0;
    const float openness = occluded ? Openness(seen.point, seen.normal, pixel, sample) : 1.0f;
    float key_share = 1.0f;
    if (occluded) {
      const Eigen::Vector3f start = seen.point + 1e-3f * reach_ * seen.normal;
      key_share = scene_.Occluded(start, specular_->key_direction(), 0.0f, 1e30f) ? 0.0f : 1.0f;
    }
    const Eigen::Vector3f diffuse =
        (1.0f - surface.metallic) * openness * albedo.cwiseProduct(options_.light.Shade(normal));
    return diffuse +
           specular_->Reflect({NormalReflectance(albedo, surface.metallic), surface.roughness},
                              normal, -seen.ray.normalized(), openness, key_share);
  }

  // Returns the share of cosine-weighted directions that are not occluded within reach.
  float Openness(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, size_t pixel,
                 int sample) const {
    // Samples that share their directions take every n-th one.
    const int n = options_.samples_per_side * options_.samples_per_side;
    const int stride = options_.occlusion_per_pixel ? n : 1;
    const int first = options_.occlusion_per_pixel ? sample : 0;
    const int all = stride * options_.occlusion_rays;
    const size_t seed =
        pixel * 64 + (options_.occlusion_per_pixel ? 0 : static_cast<size_t>(sample));
    const Eigen::Vector3f tangent = normal.unitOrthogonal();
    const Eigen::Vector3f bitangent = normal.cross(tangent);
    const float turn =
        static_cast<float>(MixedVertices(static_cast<std::uint32_t>(seed))) * 0x1.0p-32f;
    const Eigen::Vector3f start = point + 1e-3f * reach_ * normal;
    int open = 0;
    for (int i = first; i < all; i += stride) {
      // A Fibonacci disc, rotated by a hash of the pixel and lifted to the hemisphere (Malley).
      const float radius = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(all));
      const float angle = 6.2831853f * (turn + 0.618034f * static_cast<float>(i));
      const Eigen::Vector3f direction =
          radius * (std::cos(angle) * tangent + std::sin(angle) * bitangent) +
          std::sqrt(std::max(0.0f, 1.0f - radius * radius)) * normal;
      open += scene_.Occluded(start, direction, 0.0f, reach_) ? 0 : 1;
    }
    return static_cast<float>(open) / static_cast<float>(options_.occlusion_rays);
  }

  const Scene& scene_;
  const ForwardOptions& options_;
  std::optional<SpecularLight> specular_;  // if a mesh has a look
  float reach_ = 0.0f;
};

// Draws tiles of kTileWidth x kTileHeight pixels; the rays of a sample of each are a packet.
class TileRenderer {
 public:
  TileRenderer(const Scene& scene, const core::Camera& camera, const ForwardOptions& options,
               ForwardBuffers* buffers)
      : scene_(scene),
        options_(options),
        shader_(scene, options),
        buffers_(*buffers),
        origin_(camera.position().cast<float>()) {
    const Eigen::Matrix3d& turn = camera.world_from_camera.linear();
    per_x_ = (turn.col(0) / camera.fx).cast<float>();
    per_y_ = turn.col(1) / camera.fy;
    at_zero_ = turn * Eigen::Vector3d(-camera.cx / camera.fx, -camera.cy / camera.fy, 1.0);
  }

  int rows() const { return (buffers_.height + kTileHeight - 1) / kTileHeight; }

  void Draw(int row) const {
    Tile tile;
    tile.y = row * kTileHeight;
    tile.height = std::min(kTileHeight, buffers_.height - tile.y);
    for (tile.x = 0; tile.x < buffers_.width; tile.x += kTileWidth) {
      tile.width = std::min(kTileWidth, buffers_.width - tile.x);
      if (options_.shaded || options_.samples_per_side > 1) {
        DrawSamples(tile);
      } else {
        DrawGeometry(tile);
      }
    }
  }

 private:
  static constexpr int kTileWidth = 8, kTileHeight = 2;
  static_assert(kTileWidth * kTileHeight == kPacket);

  // Pixels [x, x + width) x [y, y + height).
  struct Tile {
    int x = 0, y = 0, width = 0, height = 0;
  };

  // The sums over the samples of a tile's pixels.
  struct TileSums {
    Eigen::Vector3f color[kPacket];  // linear
    int covered[kPacket] = {};
  };

  // Traces the rays through the points at (dx, dy) of the tile's pixels.
  void Trace(const Tile& tile, double dx, double dy, PacketDirections* rays,
             PacketHits* hits) const {
    for (int j = 0; j < kTileHeight; ++j) {
      const Eigen::Vector3f start = (at_zero_ + (tile.y + j + dy) * per_y_).cast<float>();
      for (int i = 0; i < kTileWidth; ++i) {
        const int k = j * kTileWidth + i;
        const float x = static_cast<float>(tile.x + i) + static_cast<float>(dx);
        rays->x[k] = start.x() + x * per_x_.x();
        rays->y[k] = start.y() + x * per_x_.y();
        rays->z[k] = start.z() + x * per_x_.z();
        rays->valid[k] = i < tile.width && j < tile.height ? -1 : 0;
      }
    }
    scene_.IntersectPacket(origin_, *rays, hits);
  }

  static Eigen::Vector3f Ray(const PacketDirections& rays, int k) {
    return {rays.x[k], rays.y[k], rays.z[k]};
  }

  // Calls body(k, at) for lane k and index `at` of each pixel of the tile.
  template <typename Body>
  void ForPixels(const Tile& tile, const Body& body) const {
    for (int j = 0; j < tile.height; ++j) {
      const size_t start = buffers_.Index(tile.x, tile.y + j);
      for (int i = 0; i < tile.width; ++i) {
        body(j * kTileWidth + i, start + static_cast<size_t>(i));
      }
    }
  }

  // Returns the shading normal of a hit on the side from which the ray comes.
  Eigen::Vector3f Normal(const PacketHits& hits, int k, const Eigen::Vector3f& ray) const {
    const TriangleNormals& normals = scene_.Normals(hits.part[k], hits.triangle[k]);
    return FacingNormal(normals.At(hits.u[k], hits.v[k]), normals.face, ray);
  }

  // One ray per pixel, without colours.
  void DrawGeometry(const Tile& tile) const {
    PacketDirections rays;
    PacketHits hits;
    Trace(tile, 0.5, 0.5, &rays, &hits);
    ForPixels(tile, [&](int k, size_t at) {
      const bool hit = hits.part[k] >= 0;
      buffers_.depth[at] = hit ? hits.depth[k] : 0.0f;
      buffers_.mask[at] = hit ? 1.0f : 0.0f;
      buffers_.label[at] = hits.part[k];
      buffers_.triangle[at] = hits.triangle[k];
      buffers_.normal[at] =
          hit ? Normal(hits, k, Ray(rays, k)) : Eigen::Vector3f(Eigen::Vector3f::Zero());
    });
  }

  void DrawSamples(const Tile& tile) const {
    const int n = options_.samples_per_side;
    PacketDirections rays;
    PacketHits hits;
    TileSums sums;
    std::fill_n(sums.color, kPacket, Eigen::Vector3f::Zero());
    Shader::LastAlbedo albedo;
    for (int sample = 0; sample < n * n; ++sample) {
      const bool representative = sample == (n / 2) * n + n / 2;
      const int column = sample % n, row = sample / n;
      Trace(tile, (column + 0.5) / n, (row + 0.5) / n, &rays, &hits);
      ForPixels(tile, [&](int k, size_t at) {
        if (representative) {
          buffers_.depth[at] = hits.part[k] >= 0 ? hits.depth[k] : 0.0f;
          buffers_.label[at] = hits.part[k];
          buffers_.triangle[at] = hits.triangle[k];
          buffers_.normal[at].setZero();
        }
        if (hits.part[k] < 0) return;
        ++sums.covered[k];
        if (!representative && !options_.shaded) return;
        const Eigen::Vector3f ray = Ray(rays, k), normal = Normal(hits, k, ray);
        if (representative) buffers_.normal[at] = normal;
        if (!options_.shaded) return;
        const Hit hit = {hits.depth[k], hits.part[k], hits.triangle[k], hits.u[k], hits.v[k]};
        const Eigen::Vector3f point = origin_ + hit.depth * ray;
        sums.color[k] += shader_.Color({hit, ray, point, normal}, at, sample, &albedo);
      });
    }
    ForPixels(tile, [&](int k, size_t at) {
      buffers_.mask[at] = static_cast<float>(sums.covered[k]) / static_cast<float>(n * n);
      if (options_.shaded) Store(sums.color[k], sums.covered[k], at);
    });
  }

  // Stores the mean of a pixel's colours; transparent black if it has none.
  void Store(const Eigen::Vector3f& sum, int count, size_t at) const {
    std::uint8_t* pixel = &buffers_.color.pixels[4 * at];
    std::fill_n(pixel, 4, 0);
    if (count == 0) return;
    const Eigen::Vector3f linear = sum / static_cast<float>(count);
    for (int c = 0; c < 3; ++c) {
      const float srgb = SrgbFromLinear(std::min(1.0f, linear[c]));
      pixel[c] = static_cast<std::uint8_t>(std::lround(255.0f * srgb));
    }
    pixel[3] = static_cast<std::uint8_t>(std::lround(255.0f * buffers_.mask[at]));
  }

  const Scene& scene_;
  const ForwardOptions& options_;
  Shader shader_;
  ForwardBuffers& buffers_;
  Eigen::Vector3f origin_;
  Eigen::Vector3f per_x_;            // the ray's change per pixel
  Eigen::Vector3d per_y_, at_zero_;  // the ray's change per row, and the ray through (0, 0)
};

}  // namespace

void RenderForward(const Scene& scene, const core::Camera& camera, const ForwardOptions& options,
                   ForwardBuffers* buffers) {
  if (camera.width < 1 || camera.height < 1 || options.samples_per_side < 1) {
    throw core::Error("an image needs at least one pixel and one sample per pixel");
  }
  buffers->width = camera.width;
  buffers->height = camera.height;
  const size_t count = static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
  buffers->depth.resize(count);
  buffers->normal.resize(count);
  buffers->mask.resize(count);
  buffers->label.resize(count);
  buffers->triangle.resize(count);
  core::Image& color = buffers->color;
  if (!options.shaded) {
    color = core::Image();
  } else if (color.width != camera.width || color.channels != 4 ||
             color.pixels.size() != 4 * count) {
    color = core::Image(camera.width, camera.height, 4);
  }
  const TileRenderer renderer(scene, camera, options, buffers);
  core::ParallelFor(renderer.rows(), [&](int row) {
    if (options.cancellable) core::CheckCancelled();
    renderer.Draw(row);
  });
}

ForwardBuffers RenderForward(const Scene& scene, const core::Camera& camera,
                             const ForwardOptions& options) {
  ForwardBuffers buffers;
  RenderForward(scene, camera, options, &buffers);
  return buffers;
}

}  // namespace simwright::render
