#include "asset_lift/priors/shape_example.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/forward.h"

namespace simwright::asset_lift {
namespace {

constexpr double kExampleDegree = M_PI / 180.0;
// Dilates walls to at least the network's depth cells: no network can learn the aliasing of thinner
// ones.
geometry::VoxelSolidOptions FilledOptions() {
  geometry::VoxelSolidOptions options;
  options.resolution = 80;
  options.sheet_cells = 2.0;
  options.growth_cells = 0.6;
  // Most catalogue meshes are shells with cracks and without an underside. They represent solids,
  // and a simulation treats them as solids.
  options.gap_cells = 2.5;
  options.on_floor = true;
  return options;
}

constexpr int kRenderSide = 96;  // of the image from which the crop is cut

core::TexturedMesh Normalised(core::TexturedMesh mesh, const Eigen::Vector3d& stretch) {
  core::Transform(Eigen::Affine3d(Eigen::Scaling(stretch)), &mesh.mesh);
  const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
  const double reach = box.isEmpty() ? 0.0 : 0.5 * box.diagonal().norm();
  if (!(reach > 0.0)) throw core::Error("a training object must have an extent");
  const Eigen::Affine3d place = Eigen::Scaling(1.0 / reach) * Eigen::Translation3d(-box.center());
  core::Transform(place, &mesh.mesh);
  return mesh;
}

// Returns the colour of a lit surface, seen from outside: (RGB, sRGB bytes).
void Shade(const render::Scene& scene, const render::Hit& hit, const Eigen::Vector3f& normal,
           const render::SphericalHarmonicsLight& light, std::uint8_t* pixel) {
  const Eigen::Vector4f albedo = scene.Albedo(hit);
  const Eigen::Vector3f irradiance = light.Shade(normal);
  for (int c = 0; c < 3; ++c) {
    const float linear = render::LinearFromSrgb(albedo[c]) * irradiance[c];
    pixel[c] = static_cast<std::uint8_t>(
        std::lround(255.0f * render::SrgbFromLinear(std::clamp(linear, 0.0f, 1.0f))));
  }
}

// Shades the farthest surface along a ray, seen from beyond the object.
void ShadeBack(const render::Scene& scene, const Eigen::Vector3f& eye, const Eigen::Vector3f& ray,
               const render::SphericalHarmonicsLight& light, std::uint8_t* pixel) {
  const float far = 2.5f * eye.norm() / ray.norm();
  const Eigen::Vector3f start = eye + far * ray;
  const render::Hit hit = scene.Intersect(start, -ray);
  if (hit.instance < 0) return;
  Eigen::Vector3f normal = scene.ShadingNormal(hit);
  if (normal.dot(ray) < 0.0f) normal = -normal;
  Shade(scene, hit, normal, light, pixel);
}

Matte MatteOf(const render::ForwardBuffers& buffers) {
  Matte matte;
  matte.left = buffers.width;
  matte.top = buffers.height;
  for (int y = 0; y < buffers.height; ++y) {
    for (int x = 0; x < buffers.width; ++x) {
      if (buffers.mask[buffers.Index(x, y)] <= 0.0f) continue;
      matte.left = std::min(matte.left, x);
      matte.right = std::max(matte.right, x + 1);
      matte.top = std::min(matte.top, y);
      matte.bottom = std::max(matte.bottom, y + 1);
    }
  }
  return matte;
}

// Returns the middle of the object's depths along the central ray.
double MiddleDepth(const core::TriangleMesh& mesh, const ViewFrame& frame) {
  const Eigen::Vector3d eye = frame.camera.position(), direction = frame.Direction();
  double near = 1e30, far = -1e30;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const double depth = (v - eye).dot(direction);
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  return 0.5 * (near + far);
}

}  // namespace

TrainingObject::TrainingObject(core::TexturedMesh mesh, const Eigen::Vector3d& stretch)
    : mesh_(Normalised(std::move(mesh), stretch)),
      solid_(std::make_unique<geometry::VoxelSolid>(mesh_.mesh, FilledOptions())) {
  scene_.Add(&mesh_);
  scene_.Commit();
}

core::Camera RandomPhotoCamera(core::Rng* rng, int side, double* elevation) {
  const double habit = 22.0 + 16.0 * core::Normal(*rng);
  *elevation = std::clamp(habit, -5.0, 72.0) * kExampleDegree;
  const double fov = core::Uniform(*rng, 12.0, 50.0) * kExampleDegree;
  const double distance = 1.06 / std::sin(0.5 * fov);
  core::Camera camera = core::OrbitCamera(Eigen::Vector3d::Zero(), distance, *elevation,
                                          core::Uniform(*rng, 0.0, 2.0 * M_PI), fov, side, side);
  const double roll = 2.0 * kExampleDegree * core::Normal(*rng);
  camera.world_from_camera.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  return camera;
}

render::SphericalHarmonicsLight RandomLight(core::Rng* rng) {
  Eigen::Vector3d key = core::UniformDirection(*rng);
  key.z() = std::abs(key.z()) + 0.3;
  render::SphericalHarmonicsLight light =
      render::SphericalHarmonicsLight::Studio(key.normalized().cast<float>());
  const auto even =
      render::SphericalHarmonicsLight::Uniform(static_cast<float>(core::Uniform(*rng, 0.6, 1.0)));
  const auto share = static_cast<float>(core::Uniform(*rng, 0.3, 1.0));
  Eigen::RowVector3f tint;
  for (int c = 0; c < 3; ++c) tint[c] = static_cast<float>(core::Uniform(*rng, 0.85, 1.1));
  light.radiance = (share * light.radiance + (1.0f - share) * even.radiance) * tint.asDiagonal();
  return light;
}

ShapeExample MakeShapeExample(const TrainingObject& object, core::Rng* rng) {
  ShapeExample example;
  core::Camera camera = RandomPhotoCamera(rng, kRenderSide, &example.elevation);
  const render::SphericalHarmonicsLight light = example.light = RandomLight(rng);
  const Matte matte = MatteOf(render::RenderForward(object.scene(), camera));
  example.frame = FrameAround(matte, camera, 1.0);
  example.frame.depth = MiddleDepth(object.mesh().mesh, example.frame);

  const core::Camera crop = example.frame.CropCamera(kCropSide);
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.light = light;
  options.occlusion_rays = core::Uniform(*rng) < 0.5 ? 4 : 0;
  example.picture = render::RenderForward(object.scene(), crop, options).color.pixels;

  const size_t pixels = static_cast<size_t>(kCropSide) * kCropSide;
  example.back.assign(3 * pixels, 0);
  example.occupancy.assign(pixels * kDepthCells, 0);
  const Eigen::Vector3d eye = crop.position(), direction = example.frame.Direction();
  const double radius = example.frame.Radius();
  for (int y = 0; y < kCropSide; ++y) {
    for (int x = 0; x < kCropSide; ++x) {
      const size_t at = static_cast<size_t>(y) * kCropSide + x;
      const Eigen::Vector3d ray = crop.Ray({x + 0.5, y + 0.5});
      if (example.picture[4 * at + 3] > 0) {
        ShadeBack(object.scene(), eye.cast<float>(), ray.cast<float>(), light,
                  &example.back[3 * at]);
      }
      const Eigen::Vector3d step = ray / ray.dot(direction);
      for (int k = 0; k < kDepthCells; ++k) {
        const double w = kDepthReach * ((k + 0.5) * 2.0 / kDepthCells - 1.0);
        const float share =
            object.solid().Occupancy(eye + (example.frame.depth + w * radius) * step);
        example.occupancy[static_cast<size_t>(k) * pixels + at] =
            static_cast<std::uint8_t>(std::lround(255.0f * share));
      }
    }
  }
  return example;
}

core::Image CropImage(const core::Image& photo, const core::Image& alpha, const ViewFrame& frame) {
  const ObservedView view = CropView(photo, alpha, frame, kCropSide);
  core::Image crop(kCropSide, kCropSide, 4);
  for (size_t i = 0; i < view.opacity.values.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      crop.pixels[4 * i + c] =
          static_cast<std::uint8_t>(std::lround(255.0f * view.color.values[3 * i + c]));
    }
    crop.pixels[4 * i + 3] =
        static_cast<std::uint8_t>(std::lround(255.0f * view.opacity.values[i]));
  }
  return crop;
}

}  // namespace simwright::asset_lift
