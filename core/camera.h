#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simwright::core {

// A pinhole camera that looks along +z, with x right and y down (OpenCV). Pixel (i, j) covers [i,
// i+1) x [j, j+1): its centre is at (i + 0.5, j + 0.5).
struct Camera {
  int width = 0;              // pixels
  int height = 0;             // pixels
  double fx = 0.0, fy = 0.0;  // focal lengths, pixels
  double cx = 0.0, cy = 0.0;  // principal point, pixels
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();

  Eigen::Vector3d position() const { return world_from_camera.translation(); }

  // Returns the direction of the ray through image point `pixel` in the world frame. Its component
  // along the optical axis is 1, so position() + depth * Ray(pixel) has that depth.
  Eigen::Vector3d Ray(const Eigen::Vector2d& pixel) const {
    return world_from_camera.linear() *
           Eigen::Vector3d((pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0);
  }

  // Projects a world point: returns the image point (x, y, pixels) and the depth (z, along the
  // optical axis, metres). Only points with depth > 0 are in front of the camera.
  Eigen::Vector3d Project(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = world_from_camera.inverse() * point;
    return {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy, p.z()};
  }
};

// Returns a camera at `distance` (m) from `target`, `elevation` (rad) above the horizontal plane
// and `azimuth` (rad) from the world's +x axis, that looks at `target` with the world's z up in the
// image. `vertical_fov` is in rad. Requires |elevation| < pi/2, distance > 0, width and height > 0.
// Throws core::Error otherwise.
Camera OrbitCamera(const Eigen::Vector3d& target, double distance, double elevation, double azimuth,
                   double vertical_fov, int width, int height);

}  // namespace simwright::core
