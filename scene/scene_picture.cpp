#include "scene/scene_picture.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/error.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::scene {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kElevation = 35.0 * kDegree, kAzimuth = 215.0 * kDegree;
constexpr double kFieldOfView = 30.0 * kDegree;

Eigen::AlignedBox3d BoundsOf(const std::vector<DrawnObject>& objects, const Palette& palette) {
  Eigen::AlignedBox3d box;
  for (const DrawnObject& object : objects) {
    for (const Eigen::Vector3d& vertex : palette.At(object.slot).visual.mesh.vertices) {
      box.extend(object.world_from_object * vertex);
    }
  }
  return box;
}

}  // namespace

core::Image ScenePicture(const std::vector<DrawnObject>& objects, const Palette& palette,
                         const core::Camera& camera) {
  if (objects.empty()) throw core::Error("a picture needs a scene with objects");
  render::Scene scene;
  for (const DrawnObject& object : objects) {
    scene.Add(&palette.At(object.slot).visual, object.world_from_object);
  }
  scene.Commit();
  render::ForwardOptions options;
  options.shaded = true;
  options.samples_per_side = 3;
  options.occlusion_rays = 8;
  return render::RenderForward(scene, camera, options).color;
}

core::Image SceneFromTheSide(const std::vector<DrawnObject>& objects, const Palette& palette,
                             int size) {
  const Eigen::AlignedBox3d box = BoundsOf(objects, palette);
  const double distance = 0.5 * box.diagonal().norm() / std::sin(0.5 * kFieldOfView);
  return ScenePicture(
      objects, palette,
      core::OrbitCamera(box.center(), distance, kElevation, kAzimuth, kFieldOfView, size, size));
}

}  // namespace simwright::scene
