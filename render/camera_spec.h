#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"

namespace simwright::render {

// Focal lengths and principal point, pixels; the centre of pixel (i, j) is (i + 0.5, j + 0.5).
struct CameraIntrinsics {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
};

// A camera that a user describes: where it is mounted, its image and its lens.
struct CameraSpec {
  std::string name;
  // The frame that carries the camera. Worlds of skills know "world", "robot" (the base), "wrist"
  // (the tool frame between the fingertips: z along the approach, y from finger to finger) and the
  // links of the robot by name; scenes know "world".
  std::string mount = "world";
  // The camera looks along its +z, x right, y down (OpenCV); m.
  Eigen::Isometry3d mount_from_camera = Eigen::Isometry3d::Identity();
  int width = 128, height = 128;  // pixels, at most 8192 a side
  // The vertical field of view, rad, with square pixels and the principal point in the middle.
  double vertical_fov = 0.8;
  std::optional<CameraIntrinsics> intrinsics;  // instead of `vertical_fov`

  // Returns false, with a line that names the camera and the value, if the name or the mount is
  // empty, the pose is not finite or its rotation no rotation (1e-6), a side is outside 1 .. 8192,
  // the field of view is outside (0.01, 3.1) rad, or the intrinsics are not finite or a focal
  // length is not positive.
  bool IsValid(std::string* error) const;
};

// Throws core::Error with the line of IsValid for the first invalid spec, and for a name that two
// specs share.
void RequireValid(const std::vector<CameraSpec>& cameras);

// Returns the camera of a valid spec with its mount at `world_from_mount`.
core::Camera CameraAt(const CameraSpec& spec, const Eigen::Isometry3d& world_from_mount);

// Returns the pose (m) of a camera at `position` that looks at `target`, with `up` upwards in its
// image. All in one frame, that of the result's left side. Throws core::Error if the three do not
// define an orientation.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& position, const Eigen::Vector3d& target,
                         const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

}  // namespace simwright::render
