#include "core/camera.h"

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace simwright::core {

Camera OrbitCamera(const Eigen::Vector3d& target, double distance, double elevation, double azimuth,
                   double vertical_fov, int width, int height) {
  if (!(distance > 0.0) || width <= 0 || height <= 0 || !(vertical_fov > 0.0) ||
      !(vertical_fov < std::numbers::pi) || !(std::abs(elevation) < std::numbers::pi / 2)) {
    throw Error(
        "a camera needs a positive distance and size, a field of view within (0, 180) "
        "degrees and an elevation within (-90, 90) degrees");
  }
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fy = camera.fx = 0.5 * height / std::tan(0.5 * vertical_fov);
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  const Eigen::Vector3d outward(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const Eigen::Vector3d forward = -outward;
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d down = forward.cross(right);
  camera.world_from_camera.linear().col(0) = right;
  camera.world_from_camera.linear().col(1) = down;
  camera.world_from_camera.linear().col(2) = forward;
  camera.world_from_camera.translation() = target + distance * outward;
  return camera;
}

}  // namespace simwright::core
