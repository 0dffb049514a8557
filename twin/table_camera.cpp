#include "twin/table_camera.h"

#include <cmath>

#include "core/error.h"

namespace simwright::twin {
namespace {

constexpr double kCameraDegree = M_PI / 180.0;

}  // namespace

bool TableCamera::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (!(elevation >= 3.0 * kCameraDegree && elevation <= 88.0 * kCameraDegree)) {
    return fail("the camera's elevation is outside 3 to 88 degrees");
  }
  if (!(std::abs(roll) <= 45.0 * kCameraDegree))
    return fail("the camera is rolled beyond 45 degrees");
  if (!(focal >= 0.3 && focal <= 10.0)) {
    return fail("the focal length is outside 0.3 to 10 widths of the picture");
  }
  if (!(height >= 0.05 && height <= 20.0)) {
    return fail("the camera's height above the table is outside 5 cm to 20 m");
  }
  return true;
}

core::Camera TableCamera::At(int width, int height_pixels) const {
  core::Camera camera;
  camera.width = width;
  camera.height = height_pixels;
  // Right, down and forward of the camera without roll.
  const double sine = std::sin(elevation), cosine = std::cos(elevation);
  Eigen::Matrix3d turn;
  turn.col(0) = Eigen::Vector3d::UnitX();
  turn.col(1) = Eigen::Vector3d(0.0, -sine, -cosine);
  turn.col(2) = Eigen::Vector3d(0.0, cosine, -sine);
  camera.world_from_camera.linear() =
      turn * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  camera.world_from_camera.translation() = height * Eigen::Vector3d::UnitZ();
  camera.fx = camera.fy = focal * width;
  camera.cx = principal.x() * width;
  camera.cy = principal.y() * height_pixels;
  return camera;
}

TableCamera TableCameraOf(const core::Camera& camera) {
  const Eigen::Matrix3d& turn = camera.world_from_camera.linear();
  if (!(turn(2, 2) < -1e-3) || !(camera.position().z() > 0.0)) {
    throw core::Error("the camera does not look down onto the table",
                      "its optical axis must meet the plane z = 0 in front of it");
  }
  TableCamera numbers;
  numbers.elevation = std::asin(-turn(2, 2));
  numbers.roll = std::atan2(-turn(2, 0), -turn(2, 1));
  numbers.focal = camera.fx / camera.width;
  numbers.height = camera.position().z();
  numbers.principal = {camera.cx / camera.width, camera.cy / camera.height};
  return numbers;
}

}  // namespace simwright::twin
