#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "assets/urdf_reader.h"
#include "robot/arm.h"
#include "robot/joint_limits.h"

namespace simwright::robot {

// Fingers that close on a thing, moved by one joint and others that follow it.
struct Gripper {
  std::vector<int> joints;          // in urdf.joints, the leader first
  std::vector<int> links;           // the fingers, in urdf.links
  double closed = 0.0, open = 0.0;  // positions of the leader, rad or m
  double opening_ratio = 2.0;       // m between the fingers for each unit of the leader
  double grip_force = 20.0;         // N of each finger; why 20: docs/robots.md

  // m between the fingers with the leader at `position`.
  double Opening(double position) const;
  double MaxOpening() const { return Opening(open); }
};

// A robot: its URDF and what no URDF says. Constant; safe from several threads.
struct RobotModel {
  std::string name;
  assets::UrdfModel urdf;
  Arm arm;                      // root to tool: the base's joints, then the arm's; `ready` is home
  std::vector<int> arm_joints;  // (J) the joints of `arm`, in urdf.joints
  int base_joint_count = 0;     // how many of them, the first, move the base
  int tool_link = 0;            // in urdf.links
  Gripper gripper;
  std::vector<JointLimits> limits;  // (urdf.joints); all zero where a joint is fixed
  LimitMargin margin;
  std::vector<std::pair<int, int>> ignored_collisions;  // links that may meet

  const Eigen::VectorXd& home() const { return arm.ready; }
  // The limits of the arm's joints, in its order. (J)
  std::vector<JointLimits> ArmLimits() const;
};

// Reads `urdf` and the side file beside it, the same name with the ending .json (docs/robots.md).
// What the side file says of no joint's rates follows from the URDF: its velocity, or 1 rad/s or
// 0.25 m/s where it has none; 3 /s of it as acceleration and 100 /s of that as jerk, both below
// what the Panda allows (3.4 and 500 /s).
// Throws core::Error, naming file, joint and remedy, where the URDF cannot be read, the side file
// is missing, no JSON or of another form, names what the URDF lacks, where the arm's joints are
// not all that moves between root and tool, in this order, or a value lies outside its limits.
RobotModel ReadRobot(const std::filesystem::path& urdf);

}  // namespace simwright::robot
