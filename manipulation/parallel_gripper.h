#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/finding.h"
#include "robot/robot_model.h"
#include "sim/gripper_model.h"

namespace simwright::manipulation {

// A gripper with two opposed sliding fingers, and what grasp files say about it.
struct ParallelGripper {
  sim::GripperModel model;
  std::string base_link;  // the link on which the fingers slide, "panda_hand"
  Eigen::Isometry3d tool_from_base = Eigen::Isometry3d::Identity();  // of that link
  // The finger joints with their positions (m) when the gripper is fully open, and the direction of
  // closing (1 or -1).
  struct Joint {
    std::string name;
    double open = 0.0;
    double closing = -1.0;
  };
  std::vector<Joint> joints;
  core::Findings findings;  // what was guessed

  // Returns the position (m) of a finger joint when the pads are `opening` (m) apart.
  double JointPosition(size_t joint, double opening) const;
};

// Returns the gripper of a robot: its fingers, and as the palm all other links from the arm's last
// joint on. Throws core::Error unless two opposed prismatic joints move the fingers along the tool
// frame's y axis.
ParallelGripper GripperOf(const robot::RobotModel& robot);

// Reads a gripper: "panda", or a URDF. With a side file (docs/robots.md) the URDF is a robot's; one
// of a gripper alone has exactly two moving joints. Its tool frame is a link whose name contains
// "tcp" or "tool", with z along the approach and y or x along the closing axis; without such a
// link, it is placed 1 cm behind the fingertips, which is a finding. Throws core::Error for other
// grippers, and where a finger has no collision shape.
ParallelGripper ReadGripper(const std::string& name_or_urdf);

}  // namespace simwright::manipulation
