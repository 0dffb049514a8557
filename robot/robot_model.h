#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "assets/kinematic_model.h"
#include "assets/urdf_reader.h"
#include "robot/arm.h"
#include "robot/joint_limits.h"

namespace simwright::robot {

// A gripper: fingers moved by one leader joint and the joints that mimic it.
struct Gripper {
  std::vector<int> joints;          // in urdf.joints, the leader first
  std::vector<int> links;           // the fingers, in urdf.links
  double closed = 0.0, open = 0.0;  // positions of the leader, rad or m
  double opening_ratio = 2.0;       // m of finger opening per unit of the leader
  double grip_force = 20.0;         // N per finger; docs/robots.md explains the value 20

  // Returns the finger opening in m with the leader at `position`.
  double Opening(double position) const;
  double MaxOpening() const { return Opening(open); }
  // Returns the position of the leader at a finger opening of `opening` m, within its range.
  double LeaderAt(double opening) const;
};

// A robot: its URDF and the data that URDF cannot express. Immutable and thread-safe.
struct RobotModel {
  std::string name;
  assets::UrdfModel urdf;
  std::shared_ptr<const assets::KinematicModel> kinematics;  // of `urdf`
  Arm arm;                      // root to tool: the base's joints, then the arm's; `ready` is home
  std::vector<int> arm_joints;  // (J) the joints of `arm`, in urdf.joints
  int base_joint_count = 0;     // how many of the first of them move the base
  int tool_link = 0;            // in urdf.links
  Gripper gripper;
  std::vector<JointLimits> limits;  // (urdf.joints); all zero for a fixed joint
  LimitMargin margin;
  std::vector<std::pair<int, int>> ignored_collisions;  // pairs of links whose contact is ignored

  const Eigen::VectorXd& home() const { return arm.ready; }
  // Returns the limits of the arm's joints, in the arm's order (J).
  std::vector<JointLimits> ArmLimits() const;
  // Returns the poses of all links in the root's frame (urdf.links), for positions of the arm's
  // joints (J, rad or m) and of the gripper's leader. Throws core::Error if there are not J.
  std::vector<Eigen::Isometry3d> LinkPoses(const Eigen::Ref<const Eigen::VectorXd>& arm_positions,
                                           double leader) const;
};

// Reads `urdf` and its side file, which has the same name with the extension .json
// (docs/robots.md). A rate that the side file does not give follows from the URDF: the URDF's
// velocity, or 1 rad/s or 0.25 m/s if it has none; 3 /s times that as acceleration and 100 /s times
// the acceleration as jerk, both below what the Panda allows (3.4 and 500 /s).
// Throws core::Error, naming file, joint and remedy, if the URDF cannot be read; the side file is
// missing, not valid JSON, or of another form; it names an element that the URDF lacks; the arm's
// joints are not exactly the moving joints between root and tool, in this order; or a value is
// outside its limits.
RobotModel ReadRobot(const std::filesystem::path& urdf);

}  // namespace simwright::robot
