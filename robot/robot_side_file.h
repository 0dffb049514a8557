#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/joint_limits.h"

namespace simwright::robot {

// The limits that the side file gives for one joint; the URDF gives the others.
struct StatedLimits {
  std::optional<double> velocity, acceleration, jerk, effort;
};

// The contents of a robot's side file, by name, not yet checked against the URDF.
struct RobotSideFile {
  std::string tool_link;
  std::vector<std::string> base_joints, arm_joints;
  std::map<std::string, double> home;  // rad or m
  std::map<std::string, StatedLimits> limits;
  LimitMargin margin;
  std::vector<std::string> gripper_joints, finger_links;
  double closed = 0.0, open = 0.0, opening_ratio = 2.0, grip_force = 20.0;  // as in Gripper
  std::vector<std::pair<std::string, std::string>> ignored_collisions;
};

// Reads a side file. Throws core::Error if the file is missing, larger than 1 MiB, not valid JSON,
// or of another form.
RobotSideFile ReadRobotSideFile(const std::filesystem::path& path);

}  // namespace simwright::robot
