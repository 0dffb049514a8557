#pragma once

#include "assets/primitive_meshes.h"
#include "core/mesh.h"
#include "sim/gripper_model.h"

namespace simwright::sim {

// Returns a box of `size` (m) around `center` (m).
inline core::TriangleMesh BoxAround(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
  core::TriangleMesh mesh = assets::BoxMesh(size);
  core::Transform(Eigen::Affine3d(Eigen::Translation3d(center)), &mesh);
  return mesh;
}

// Returns a gripper whose fingers are boxes of 2 x 1 x 4 cm, the pads at y = +-4 cm when it is
// open. `force`: N of each finger.
inline GripperModel PlainGripper(double force) {
  GripperModel gripper;
  gripper.name = "plain";
  gripper.max_opening = 0.08;
  gripper.force = force;
  gripper.palm = {BoxAround({0, 0, -0.06}, {0.06, 0.2, 0.06})};
  gripper.fingers[0] = {BoxAround({0, 0.045, -0.01}, {0.02, 0.01, 0.04})};
  gripper.fingers[1] = {BoxAround({0, -0.045, -0.01}, {0.02, 0.01, 0.04})};
  return gripper;
}

}  // namespace simwright::sim
