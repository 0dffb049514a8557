#include "library_fit/fit_view.h"

#include <algorithm>
#include <cmath>

namespace simwright::library_fit {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kSphereMargin = 1.06;  // of the picture about the object's sphere

// Sets the pose of `camera`, with a focal length of one pixel about the image's origin, and returns
// the bounding box of the mesh in it.
Eigen::AlignedBox2d PoseCamera(const FitView& view, const core::TriangleMesh& mesh, int side,
                               core::Camera* camera) {
  const Eigen::AlignedBox3d bounds = core::Bounds(mesh);
  const double distance = 0.5 * bounds.diagonal().norm() / view.nearness;
  *camera =
      core::OrbitCamera(bounds.center(), distance, view.elevation, view.azimuth, 1.0, side, side);
  camera->world_from_camera.rotate(Eigen::AngleAxisd(view.roll, Eigen::Vector3d::UnitZ()));
  camera->fx = camera->fy = 1.0;
  camera->cx = camera->cy = 0.0;
  const Eigen::Isometry3d camera_from_world = camera->world_from_camera.inverse();
  Eigen::AlignedBox2d seen;
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    const Eigen::Vector3d p = camera_from_world * vertex;
    seen.extend(Eigen::Vector2d(p.head<2>() / p.z()));
  }
  return seen;
}

void Zoom(double focal, const Eigen::Vector2d& middle, const Eigen::AlignedBox2d& seen,
          core::Camera* camera) {
  camera->fx = camera->fy = focal;
  camera->cx = middle.x() - focal * seen.center().x();
  camera->cy = middle.y() - focal * seen.center().y();
}

}  // namespace

core::Camera CameraOf(const FitView& view, const core::TriangleMesh& mesh,
                      const Eigen::AlignedBox2d& box, int side) {
  core::Camera camera;
  const Eigen::AlignedBox2d seen = PoseCamera(view, mesh, side, &camera);
  Zoom(box.sizes().sum() / std::max(seen.sizes().sum(), 1e-9), box.center(), seen, &camera);
  return camera;
}

core::Camera CropCameraOf(const FitView& view, const core::TriangleMesh& mesh,
                          const Eigen::Vector2d& middle, double half, int side) {
  core::Camera camera;
  const Eigen::AlignedBox2d seen = PoseCamera(view, mesh, side, &camera);
  Zoom(2.0 * half / std::max(seen.sizes().maxCoeff(), 1e-9), middle, seen, &camera);
  return camera;
}

FitView RandomView(bool frontal, core::Rng* rng) {
  FitView view;
  view.elevation = std::clamp(22.0 + 16.0 * core::Normal(*rng), -5.0, 72.0) * kDegree;
  const double fov = core::Uniform(*rng, 12.0, 50.0) * kDegree;
  view.nearness = std::sin(0.5 * fov) / kSphereMargin;
  view.roll = 2.0 * kDegree * core::Normal(*rng);
  view.azimuth = core::Uniform(*rng, 0.0, 2.0 * M_PI);
  if (frontal) {
    view.azimuth = M_PI + std::clamp(40.0 * core::Normal(*rng), -80.0, 80.0) * kDegree;
  }
  return view;
}

}  // namespace simwright::library_fit
