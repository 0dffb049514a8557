#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "manipulation/interaction_target.h"

namespace simwright::manipulation {

// The extent and motion of the interaction target, in a frame at the gripper.
struct TargetGeometry {
  // The size (m) of the AABB of the part's convex hull points (of the whole object's, if no joint
  // moves it) along the frame's axes.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // m, from the frame's origin
  // The direction in which the part at the frame's origin moves as its joint position increases:
  // unit; zero without a joint, or on its axis.
  Eigen::Vector3d motion_direction = Eigen::Vector3d::Zero();
  // The vector (m) from the frame's origin to the nearest point of the part's rotation axis; zero
  // for a prismatic joint and without a joint.
  Eigen::Vector3d hinge = Eigen::Vector3d::Zero();
};

// `world_from_frame`: usually GraspPose.
TargetGeometry GeometryOf(const tasks::WorldModel& model, const tasks::WorldState& state,
                          const InteractionTarget& target,
                          const Eigen::Isometry3d& world_from_frame);

}  // namespace simwright::manipulation
