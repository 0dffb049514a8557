#pragma once

#include <string>

#include <Eigen/Core>

#include "core/camera.h"
#include "core/image.h"

namespace simwright::capture {

// A camera's intrinsics with the Brown-Conrady distortion of OpenCV: for (x, y) = (X / Z, Y / Z)
// and r^2 = x^2 + y^2, the image point is
//   u = fx (x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)) + cx
//   v = fy (y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y) + cy
struct Lens {
  int width = 0, height = 0;  // pixels
  double fx = 0.0, fy = 0.0;  // pixels
  double cx = 0.0, cy = 0.0;  // pixels
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, p1 = 0.0, p2 = 0.0;

  // Returns the image point of a point in the camera's frame, whose z is > 0.
  Eigen::Vector2d Project(const Eigen::Vector3d& point) const;
};

// Returns the camera of a crop of the photo without distortion: the part of the photo that shows
// the box `region` (world, m) from `world_from_camera`, scaled down so that its longer side has at
// most `max_side` pixels. Throws core::Error if the photo shows nothing of the region.
core::Camera CropAround(const Eigen::AlignedBox3d& region, const Lens& lens,
                        const Eigen::Isometry3d& world_from_camera, int max_side);

// Returns the image that the pinhole camera `crop` sees instead of the lens: distortion removed, by
// averages over areas where it is smaller and bilinear interpolation. The crop's pose is not used.
// Pixels that the photo does not show repeat its border. Throws core::Error if the photo has
// another size than the lens, or the crop no pixels.
core::Image RemoveDistortion(const core::Image& photo, const Lens& lens, const core::Camera& crop);

}  // namespace simwright::capture
