#include "twin/table_pose.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace simwright::twin {
namespace {

constexpr int kMostPoints = 400;  // of a mesh that are projected
constexpr int kSteps = 8;
constexpr double kLargestStep = 0.5;  // of the logarithm of the scale, and of the distance

Eigen::Vector3d BoxNumbers(const Eigen::AlignedBox2d& box) {
  return {box.center().x(), box.center().y(), box.sizes().sum()};
}

}  // namespace

Eigen::Isometry3d TablePose::WorldFromObject() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(x, y, 0.0);
  return pose;
}

Eigen::AlignedBox2d ProjectedBox(const core::TriangleMesh& mesh, const ScaledPose& pose,
                                 const core::Camera& camera) {
  const Eigen::Isometry3d camera_from_object =
      camera.world_from_camera.inverse() * pose.pose.WorldFromObject();
  Eigen::AlignedBox2d box;
  const size_t stride = std::max<size_t>(1, mesh.vertices.size() / kMostPoints);
  for (size_t i = 0; i < mesh.vertices.size(); i += stride) {
    const Eigen::Vector3d p = camera_from_object * (pose.scale * mesh.vertices[i]);
    if (p.z() < 1e-3) return {};
    box.extend(Eigen::Vector2d(camera.fx * p.x() / p.z() + camera.cx,
                               camera.fy * p.y() / p.z() + camera.cy));
  }
  return box;
}

ScaledPose PoseFromBox(const core::TriangleMesh& mesh, double yaw, const core::Camera& camera,
                       const Eigen::AlignedBox2d& box) {
  // The start: the object's middle lies on the ray through the middle of its box.
  const Eigen::Vector3d ray = camera.Ray(box.center());
  const double height = camera.position().z();
  const double depth = height / std::max(1e-3 * ray.norm(), -ray.z());
  const Eigen::Vector3d ground = camera.position() + 0.95 * depth * ray;
  ScaledPose best;
  best.pose = {ground.x(), ground.y(), yaw};
  const Eigen::AlignedBox2d first = ProjectedBox(mesh, best, camera);
  if (first.isEmpty()) return best;
  best.scale = std::clamp(box.sizes().sum() / first.sizes().sum(), 1e-2, 1e2);
  const Eigen::Vector3d wanted = BoxNumbers(box);
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::AlignedBox2d now = ProjectedBox(mesh, best, camera);
    if (now.isEmpty()) break;
    const Eigen::Vector3d off = wanted - BoxNumbers(now);
    if (off.norm() < 1e-3) break;
    Eigen::Matrix3d jacobian;
    const double move = 1e-3 * depth;
    for (int i = 0; i < 3; ++i) {
      ScaledPose moved = best;
      if (i == 0) moved.pose.x += move;
      if (i == 1) moved.pose.y += move;
      if (i == 2) moved.scale *= std::exp(1e-3);
      const Eigen::AlignedBox2d other = ProjectedBox(mesh, moved, camera);
      if (other.isEmpty()) return best;
      jacobian.col(i) = (BoxNumbers(other) - BoxNumbers(now)) / 1e-3;
    }
    Eigen::Vector3d change = jacobian.fullPivLu().solve(off);
    if (!change.allFinite()) break;
    change *= std::min(1.0, kLargestStep / std::max(1e-9, change.cwiseAbs().maxCoeff()));
    ScaledPose next = best;
    next.pose.x += change[0] * depth;
    next.pose.y += change[1] * depth;
    next.scale *= std::exp(change[2]);
    if (ProjectedBox(mesh, next, camera).isEmpty()) break;
    best = next;
  }
  return best;
}

}  // namespace simwright::twin
