#pragma once

#include <filesystem>
#include <string>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

// ROS 2's trajectory_msgs/JointTrajectory as YAML (accepted by `ros2 topic pub` and printed by
// `ros2 topic echo`) or JSON, and a CSV table. docs/formats.md describes them.
enum class TrajectoryFormat { kRosYaml, kRosJson, kCsv };

// Returns the format of the extension: .yaml or .yml, .json, .csv. Throws core::Error for another
// one.
TrajectoryFormat TrajectoryFormatOf(const std::filesystem::path& path);

// Returns the text of the file. Numbers have the shortest text that parses to the same value; times
// are rounded to nanoseconds in the ROS formats. Notes become comments; JSON has none. Throws
// core::Error if the trajectory is malformed, the name of a joint or note contains more than
// letters, digits, '_', '-', '.', '/', a note exceeds one line, or two times are equal after
// rounding in a ROS format.
std::string TrajectoryText(const JointTrajectory& trajectory, TrajectoryFormat format);

// Parses the output of TrajectoryText, and ROS YAML with lists of one entry per line. Throws
// core::Error, naming `where` and the line or location, for truncated text, an invalid number, NaN,
// a count that differs from that of the joints, times that do not increase, an unknown member, more
// than 64 joints or more than 2,000,000 samples.
JointTrajectory ParseTrajectory(const std::string& text, TrajectoryFormat format,
                                const std::string& where);

// Writes or reads a file of at most 1 GiB, in the format of its extension. Throws core::Error as
// above, or if the file cannot be read or written.
void WriteTrajectory(const std::filesystem::path& path, const JointTrajectory& trajectory);
JointTrajectory ReadTrajectory(const std::filesystem::path& path);

}  // namespace simwright::robot
