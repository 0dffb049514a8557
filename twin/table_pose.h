#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::twin {

// The pose of an object that stands on the table: m and rad.
struct TablePose {
  double x = 0.0, y = 0.0, yaw = 0.0;

  Eigen::Isometry3d WorldFromObject() const;
};

// A pose with a factor of the object's size.
struct ScaledPose {
  TablePose pose;
  double scale = 1.0;
};

// Returns the pose and the scale with which the mesh, turned by `yaw` and standing on z = 0, has
// the bounding box `box` (pixels) in the picture: its middle and the sum of its sides. By Newton's
// method; where it leads behind the camera or beyond the horizon, the last point before.
ScaledPose PoseFromBox(const core::TriangleMesh& mesh, double yaw, const core::Camera& camera,
                       const Eigen::AlignedBox2d& box);

// Returns the bounding box (pixels) of the mesh, scaled, in its pose; empty if a vertex is not in
// front of the camera.
Eigen::AlignedBox2d ProjectedBox(const core::TriangleMesh& mesh, const ScaledPose& pose,
                                 const core::Camera& camera);

}  // namespace simwright::twin
