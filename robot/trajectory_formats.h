#pragma once

#include <string>
#include <string_view>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

// The writers and readers of the formats; TrajectoryText and ParseTrajectory document arguments and
// errors.
std::string RosYamlText(const JointTrajectory& trajectory);
std::string RosJsonText(const JointTrajectory& trajectory);
std::string CsvText(const JointTrajectory& trajectory);
JointTrajectory ParseRosYaml(std::string_view text, const std::string& where);
JointTrajectory ParseRosJson(const std::string& text, const std::string& where);
JointTrajectory ParseCsv(std::string_view text, const std::string& where);

}  // namespace simwright::robot
