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
  core::Camera camera = core::OrbitCamera(Eigen::Vector3d::Zero(), height / std::sin(elevation),
                                          elevation, -0.5 * M_PI, 1.0, width, height_pixels);
  camera.world_from_camera.rotate(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()));
  camera.fx = camera.fy = focal * width;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height_pixels;
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
  return numbers;
}

}  // namespace simwright::twin
