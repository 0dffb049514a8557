#include "render/forward.h"

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

class RowRenderer {
 public:
  RowRenderer(const Scene& scene, const core::Camera& camera, const ForwardOptions& options,
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

  void Draw(int y) const {
    if (options_.samples_per_side == 1) {
      DrawSingleRays(y);
    } else {
      Shader::LastAlbedo albedo;
      for (int x = 0; x < buffers_.width; ++x) DrawPixel(x, y, &albedo);
    }
  }

 private:
  // Returns the ray through image point (0, y), world; the next pixel to the right adds `per_x_`.
  Eigen::Vector3f RowStart(double y) const { return (at_zero_ + y * per_y_).cast<float>(); }

  // Returns the shading normal on the side from which the ray comes.
  Eigen::Vector3f FacingNormal(const Hit& hit, const Eigen::Vector3f& ray) const {
    const Eigen::Vector3f normal = scene_.ShadingNormal(hit);
    return normal.dot(ray) > 0.0f ? OrientedNormal(hit, normal, ray) : normal;
  }

  // Orients the normal towards the camera: flips it for a back face. If the smooth normal of a
  // front face seen at a grazing angle points away, it is moved to the horizon, not behind the
  // face.
  Eigen::Vector3f OrientedNormal(const Hit& hit, Eigen::Vector3f normal,
                                 const Eigen::Vector3f& ray) const {
    const Eigen::Matrix3f c = scene_.Corners(hit.instance, hit.triangle);
    const Eigen::Vector3f face = (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0));
    if (face.dot(ray) > 0.0f) normal = -normal;
    const float away = normal.dot(ray) / ray.squaredNorm();
    return away > 0.0f ? (normal - away * ray).stableNormalized() : normal;
  }

  void Keep(const Hit& hit, const Eigen::Vector3f& normal, size_t at) const {
    buffers_.depth[at] = hit.depth;
    buffers_.normal[at] = normal;
    buffers_.label[at] = hit.instance;
    buffers_.triangle[at] = hit.triangle;
  }

  // With one ray per pixel, neighbouring pixels are traced in bundles.
  void DrawSingleRays(int y) const {
    const Eigen::Vector3f start = RowStart(y + 0.5);
    Eigen::Vector3f rays[kRayBundle];
    Hit hits[kRayBundle];
    Shader::LastAlbedo albedo;
    for (int first = 0; first < buffers_.width; first += kRayBundle) {
      const int count = std::min(kRayBundle, buffers_.width - first);
      for (int k = 0; k < count; ++k) {
        rays[k] = start + (static_cast<float>(first + k) + 0.5f) * per_x_;
      }
      scene_.IntersectBundle(origin_, rays, count, hits);
      for (int k = 0; k < count; ++k) {
        if (hits[k].instance < 0) continue;
        const size_t at = buffers_.Index(first + k, y);
        const Eigen::Vector3f normal = FacingNormal(hits[k], rays[k]);
        Keep(hits[k], normal, at);
        buffers_.mask[at] = 1.0f;
        if (!options_.shaded) continue;
        const Eigen::Vector3f point = origin_ + hits[k].depth * rays[k];
        Store(shader_.Color({hits[k], rays[k], point, normal}, at, 0, &albedo), at, first + k, y);
      }
    }
  }

  // The samples of a pixel, in rows, are traced in bundles.
  void DrawPixel(int x, int y, Shader::LastAlbedo* albedo) const {
    const int n = options_.samples_per_side;
    const size_t at = buffers_.Index(x, y);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    int covered = 0;
    Eigen::Vector3f rays[kRayBundle];
    Hit hits[kRayBundle];
    for (int first = 0; first < n * n; first += kRayBundle) {
      const int count = std::min(kRayBundle, n * n - first);
      for (int k = 0; k < count; ++k) rays[k] = SampleRay(x, y, first + k);
      if (count > 1) {
        scene_.IntersectBundle(origin_, rays, count, hits);
      } else {
        hits[0] = scene_.Intersect(origin_, rays[0]);
      }
      for (int k = 0; k < count; ++k) {
        const Hit& hit = hits[k];
        if (hit.instance < 0) continue;
        ++covered;
        const bool representative = first + k == (n / 2) * n + n / 2;
        if (!representative && !options_.shaded) continue;
        const Eigen::Vector3f normal = FacingNormal(hit, rays[k]);
        if (representative) Keep(hit, normal, at);
        if (!options_.shaded) continue;
        const Eigen::Vector3f point = origin_ + hit.depth * rays[k];
        sum += shader_.Color({hit, rays[k], point, normal}, at, first + k, albedo);
      }
    }
    buffers_.mask[at] = static_cast<float>(covered) / static_cast<float>(n * n);
    if (options_.shaded && covered > 0) Store(sum / static_cast<float>(covered), at, x, y);
  }

  // Returns the ray of a pixel's sample, which are counted in rows.
  Eigen::Vector3f SampleRay(int x, int y, int sample) const {
    const int n = options_.samples_per_side, i = sample % n, j = sample / n;
    return RowStart(y + (j + 0.5) / n) +
           (static_cast<float>(x) + (static_cast<float>(i) + 0.5f) / n) * per_x_;
  }

  void Store(const Eigen::Vector3f& linear, size_t at, int x, int y) const {
    std::uint8_t* pixel = buffers_.color.At(x, y);
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

ForwardBuffers RenderForward(const Scene& scene, const core::Camera& camera,
                             const ForwardOptions& options) {
  if (camera.width < 1 || camera.height < 1 || options.samples_per_side < 1) {
    throw core::Error("an image needs at least one pixel and one sample per pixel");
  }
  ForwardBuffers buffers;
  buffers.width = camera.width;
  buffers.height = camera.height;
  const size_t count = static_cast<size_t>(camera.width) * camera.height;
  buffers.depth.assign(count, 0.0f);
  buffers.normal.assign(count, Eigen::Vector3f::Zero());
  buffers.mask.assign(count, 0.0f);
  buffers.label.assign(count, -1);
  buffers.triangle.assign(count, -1);
  if (options.shaded) buffers.color = core::Image(camera.width, camera.height, 4);
  const RowRenderer renderer(scene, camera, options, &buffers);
  core::ParallelFor(camera.height, [&](int y) {
    if (options.cancellable) core::CheckCancelled();
    renderer.Draw(y);
  });
  return buffers;
}

}  // namespace simwright::render
