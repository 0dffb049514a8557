#include "render/turntable.h"

#include <cmath>
#include <numbers>

#include "core/camera.h"
#include "render/forward.h"

namespace simwright::render {

std::vector<core::Image> Turntable(const core::TexturedMesh& mesh,
                                   const TurntableOptions& options) {
  Scene scene;
  scene.Add(&mesh, Eigen::Isometry3d::Identity(), options.look);
  scene.Commit();
  const Eigen::AlignedBox3d box = core::Bounds(mesh.mesh);
  constexpr double kFov = 0.5;
  const double radius = 0.5 * box.diagonal().norm();
  const double distance = 1.04 * radius / std::sin(0.5 * kFov);
  ForwardOptions forward;
  forward.samples_per_side = options.samples_per_side;
  forward.shaded = true;
  // At least 18 rays a pixel, over all its samples.
  const int samples = options.samples_per_side * options.samples_per_side;
  forward.occlusion_rays = (18 + samples - 1) / samples;
  forward.occlusion_per_pixel = true;
  std::vector<core::Image> images;
  for (int i = 0; i < options.views; ++i) {
    const double azimuth = options.first_azimuth + 2.0 * std::numbers::pi * i / options.views;
    const core::Camera camera = core::OrbitCamera(box.center(), distance, options.elevation,
                                                  azimuth, kFov, options.size, options.size);
    // The key light rotates with the camera: every view is lit from its upper left.
    const Eigen::Vector3f right = camera.world_from_camera.linear().col(0).cast<float>();
    const Eigen::Vector3f back = -camera.world_from_camera.linear().col(2).cast<float>();
    forward.light = SphericalHarmonicsLight::Studio(
        (-0.5f * right + 0.6f * back + 0.7f * Eigen::Vector3f::UnitZ()).normalized());
    images.push_back(RenderForward(scene, camera, forward).color);
  }
  return images;
}

core::Image Preview(const core::TexturedMesh& mesh, const TurntableOptions& options) {
  return core::ContactSheet(Turntable(mesh, options), options.views);
}

}  // namespace simwright::render
