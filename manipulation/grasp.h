#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "sim/grasped_part.h"
#include "sim/rigid_body.h"

namespace simwright::manipulation {

// An antipodal grasp of a rigid object, or of a link of an articulated one, by a gripper with two
// parallel fingers. The object's frame is the link's.
struct Grasp {
  // The tool frame before the fingers close: its origin lies in the middle between the fingertips,
  // z points along the approach, y from finger to finger.
  Eigen::Isometry3d object_from_tool = Eigen::Isometry3d::Identity();
  double width = 0.0;    // m between the contacts
  double opening = 0.0;  // m between the pads before closing
  // The contacts of the fingers at -y and +y with the outward normals of the surface, object frame.
  std::array<Eigen::Vector3d, 2> contacts = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 2> normals = {-Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY()};
  // True if the gripper also clears the plane z = 0 on which the object stands.
  bool clears_support = false;
  // The share of trials from perturbed poses in which the object was held; 0 before the proof.
  double quality = 0.0;
  // The names of the link, in whose frame the grasp is, and of the joint that it moves; empty for a
  // rigid object.
  std::string link = {}, joint = {};

  Eigen::Vector3d Approach() const { return object_from_tool.linear().col(2); }
  Eigen::Vector3d Center() const { return 0.5 * (contacts[0] + contacts[1]); }
};

// The object of grasps.
struct GraspObject {
  std::string name;
  core::TriangleMesh surface;  // closed and outward; or closed outward parts that may overlap
  sim::RigidBody body;         // for collisions and physics, in the same frame
  // The lowest friction coefficient of its surface against wood or plastic; that of fingers and
  // surface is the product with GripperModel::friction.
  double friction = 0.5;
  // Convex parts around it: the gripper clears the first at the grasp and on its approach, and the
  // others at the grasp alone.
  std::vector<core::TriangleMesh> obstacles = {}, passed = {};
  // The pose of the object in the frame of its support, the plane z = 0.
  Eigen::Isometry3d support_from_object = Eigen::Isometry3d::Identity();
  // The link of an articulated body that the object is; none: it is a free rigid body.
  std::optional<sim::GraspedPart> part = std::nullopt;
};

// Returns the angle (rad) between two grasp orientations. A gripper is symmetric under a half turn
// about its approach axis.
double GraspAngle(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

// Returns the indices of up to `count` grasps by farthest-point sampling on position and
// orientation, beginning with grasps[0]: 2 cm are as far as 30 degrees.
std::vector<int> FarthestGrasps(const std::vector<Grasp>& grasps, int count);

// Returns the share of `grasps` that are represented in `chosen`: within 2 cm, and approached
// within 30 degrees. 0 if there are none.
double GraspCoverage(const std::vector<Grasp>& grasps, const std::vector<Grasp>& chosen);

}  // namespace simwright::manipulation
