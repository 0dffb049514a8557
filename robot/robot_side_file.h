#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "robot/joint_limits.h"

namespace simwright::robot {

// What the side file gives for one joint; the URDF gives the rest.
struct StatedLimits {
  std::optional<double> velocity, acceleration, jerk, effort;
};

// A robot's side file as it stands, by names: no URDF has been asked about them yet.
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

// Throws core::Error where the file is missing, over 1 MiB, no JSON, or of another form.
RobotSideFile ReadRobotSideFile(const std::filesystem::path& path);

}  // namespace simwright::robot
