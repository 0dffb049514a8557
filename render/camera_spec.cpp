#include "render/camera_spec.h"

#include <cmath>
#include <set>
#include <sstream>

#include "core/error.h"

namespace simwright::render {
namespace {

constexpr int kMostPixels = 8192;  // a side
constexpr double kLeastFov = 0.01, kMostFov = 3.1;

template <typename... Parts>
bool Refuse(const CameraSpec& spec, std::string* error, const Parts&... parts) {
  if (error != nullptr) {
    std::ostringstream line;
    line << "camera '" << spec.name << "': ";
    (line << ... << parts);
    *error = line.str();
  }
  return false;
}

bool IsPoseValid(const CameraSpec& spec, std::string* error) {
  const Eigen::Isometry3d& pose = spec.mount_from_camera;
  if (!pose.matrix().allFinite()) return Refuse(spec, error, "its pose is not finite");
  const Eigen::Matrix3d& turn = pose.linear();
  const double skew = (turn * turn.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (skew > 1e-6 || turn.determinant() < 0.0) {
    return Refuse(spec, error, "its rotation is not orthonormal and right-handed (error ", skew,
                  ", determinant ", turn.determinant(), ")");
  }
  return true;
}

bool IsLensValid(const CameraSpec& spec, std::string* error) {
  if (!spec.intrinsics) {
    const bool inside = spec.vertical_fov > kLeastFov && spec.vertical_fov < kMostFov;
    return inside || Refuse(spec, error, "vertical_fov is ", spec.vertical_fov, " rad, outside ",
                            kLeastFov, " to ", kMostFov);
  }
  const CameraIntrinsics& lens = *spec.intrinsics;
  for (const auto& [name, value] : {std::pair{"fx", lens.fx}, std::pair{"fy", lens.fy}}) {
    if (!std::isfinite(value) || value <= 0.0) {
      return Refuse(spec, error, name, " is ", value, " pixels, but must be positive");
    }
  }
  for (const auto& [name, value] : {std::pair{"cx", lens.cx}, std::pair{"cy", lens.cy}}) {
    if (!std::isfinite(value)) return Refuse(spec, error, name, " is ", value, ", not finite");
  }
  return true;
}

}  // namespace

bool CameraSpec::IsValid(std::string* error) const {
  if (name.empty()) return Refuse(*this, error, "a camera needs a name");
  if (mount.empty()) return Refuse(*this, error, "mount is empty");
  for (const auto& [side, pixels] : {std::pair{"width", width}, std::pair{"height", height}}) {
    if (pixels < 1 || pixels > kMostPixels) {
      return Refuse(*this, error, side, " is ", pixels, " pixels, outside 1 to ", kMostPixels);
    }
  }
  return IsPoseValid(*this, error) && IsLensValid(*this, error);
}

void RequireValid(const std::vector<CameraSpec>& cameras) {
  std::set<std::string> names;
  for (const CameraSpec& camera : cameras) {
    std::string error;
    if (!camera.IsValid(&error)) throw core::Error(error);
    if (!names.insert(camera.name).second) {
      throw core::Error("two cameras are called '" + camera.name + "'", "",
                        "give each its own name");
    }
  }
}

core::Camera CameraAt(const CameraSpec& spec, const Eigen::Isometry3d& world_from_mount) {
  core::Camera camera;
  camera.width = spec.width;
  camera.height = spec.height;
  if (spec.intrinsics) {
    camera.fx = spec.intrinsics->fx, camera.fy = spec.intrinsics->fy;
    camera.cx = spec.intrinsics->cx, camera.cy = spec.intrinsics->cy;
  } else {
    camera.fx = camera.fy = 0.5 * spec.height / std::tan(0.5 * spec.vertical_fov);
    camera.cx = 0.5 * spec.width, camera.cy = 0.5 * spec.height;
  }
  camera.world_from_camera = world_from_mount * spec.mount_from_camera;
  return camera;
}

Eigen::Isometry3d LookAt(const Eigen::Vector3d& position, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up) {
  const Eigen::Vector3d forward = target - position, right = forward.cross(up);
  if (!(right.norm() > 1e-9)) {
    throw core::Error("a camera cannot look along its own up direction, or at its own position");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear().col(0) = right.normalized();
  pose.linear().col(2) = forward.normalized();
  pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
  pose.translation() = position;
  return pose;
}

}  // namespace simwright::render
