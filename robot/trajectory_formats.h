#pragma once

#include <string>
#include <string_view>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

// Each format's writer and reader; TrajectoryText and ParseTrajectory say what they take and throw.
std::string RosYamlText(const JointTrajectory& trajectory);
std::string RosJsonText(const JointTrajectory& trajectory);
std::string CsvText(const JointTrajectory& trajectory);
JointTrajectory ParseRosYaml(std::string_view text, const std::string& where);
JointTrajectory ParseRosJson(const std::string& text, const std::string& where);
JointTrajectory ParseCsv(std::string_view text, const std::string& where);

}  // namespace simwright::robot
