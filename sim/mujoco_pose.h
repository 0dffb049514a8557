#pragma once

#include <Eigen/Geometry>

namespace simwright::sim {

// MuJoCo's position of a free joint is seven numbers: x, y, z (m) and a quaternion w, x, y, z.

// Writes world_from_body to the seven numbers at `q`.
inline void WriteMujocoPose(const Eigen::Isometry3d& pose, double* q) {
  const Eigen::Quaterniond turn(pose.linear());
  Eigen::Map<Eigen::Vector3d> position(q);
  position = pose.translation();
  q[3] = turn.w();
  q[4] = turn.x();
  q[5] = turn.y();
  q[6] = turn.z();
}

// Returns world_from_body of the seven numbers at `q`; the quaternion need not be normalised.
inline Eigen::Isometry3d ReadMujocoPose(const double* q) {
  Eigen::Isometry3d pose(Eigen::Quaterniond(q[3], q[4], q[5], q[6]).normalized());
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(q);
  return pose;
}

}  // namespace simwright::sim
