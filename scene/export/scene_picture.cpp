#include "scene/export/scene_picture.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "core/error.h"
#include "render/forward.h"
#include "render/scene.h"

namespace simwright::scene {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kElevation = 35.0 * kDegree, kAzimuth = 215.0 * kDegree;
constexpr double kPictureFieldOfView = 30.0 * kDegree;
// From this multiple of the scene's size the projection is almost orthographic.
constexpr double kFarAbove = 50.0;
constexpr double kRim = 1.06;  // ratio of the image's width to the scene's

Eigen::AlignedBox3d BoundsOf(const std::vector<SceneObject>& objects, const AssetSet& asset_set) {
  Eigen::AlignedBox3d box;
  for (const SceneObject& object : objects) {
    for (const Eigen::Vector3d& vertex : asset_set.At(object.category).visual.mesh.vertices) {
      box.extend(object.world_from_object * vertex);
    }
  }
  return box;
}

}  // namespace

core::Image RenderScene(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        const core::Camera& camera, int samples_per_side) {
  if (objects.empty()) throw core::Error("a picture needs a scene with objects");
  render::Scene scene;
  for (const SceneObject& object : objects) {
    scene.Add(&asset_set.At(object.category).visual, object.world_from_object);
  }
  scene.Commit();
  render::ForwardOptions options;
  options.shaded = true;
  options.samples_per_side = samples_per_side;
  options.occlusion_rays = 8;
  return render::RenderForward(scene, camera, options).color;
}

core::Camera SideCamera(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                        int size) {
  const Eigen::AlignedBox3d box = BoundsOf(objects, asset_set);
  const double distance = 0.5 * box.diagonal().norm() / std::sin(0.5 * kPictureFieldOfView);
  return core::OrbitCamera(box.center(), distance, kElevation, kAzimuth, kPictureFieldOfView, size,
                           size);
}

core::Camera AboveCamera(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                         int size) {
  const Eigen::AlignedBox3d box = BoundsOf(objects, asset_set);
  core::Camera camera;
  camera.width = camera.height = size;
  camera.cx = camera.cy = 0.5 * size;
  const double wide = kRim * std::max(1e-3, box.sizes().head<2>().maxCoeff());
  const double distance = kFarAbove * std::max(wide, box.sizes().z());
  // The scale of the top, which is nearest and therefore largest.
  camera.fx = camera.fy = size * distance / wide;
  camera.world_from_camera.linear().col(0) = Eigen::Vector3d::UnitX();
  camera.world_from_camera.linear().col(1) = -Eigen::Vector3d::UnitY();
  camera.world_from_camera.linear().col(2) = -Eigen::Vector3d::UnitZ();
  camera.world_from_camera.translation() = box.center();
  camera.world_from_camera.translation().z() = box.max().z() + distance;
  return camera;
}

core::Image RenderFromSide(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                           int size) {
  return RenderScene(objects, asset_set, SideCamera(objects, asset_set, size));
}

core::Image RenderFromAbove(const std::vector<SceneObject>& objects, const AssetSet& asset_set,
                            int size) {
  return RenderScene(objects, asset_set, AboveCamera(objects, asset_set, size));
}

}  // namespace simwright::scene
