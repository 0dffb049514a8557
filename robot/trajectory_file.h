#pragma once

#include <filesystem>
#include <string>

#include "robot/joint_trajectory.h"

namespace simwright::robot {

// ROS 2's trajectory_msgs/JointTrajectory as YAML (what `ros2 topic pub` takes and `ros2 topic
// echo` prints) or JSON, and a table. docs/formats.md describes them.
enum class TrajectoryFormat { kRosYaml, kRosJson, kCsv };

// By the file's ending: .yaml or .yml, .json, .csv. Throws core::Error for another.
TrajectoryFormat TrajectoryFormatOf(const std::filesystem::path& path);

// The file's text. Numbers are the shortest that read back as the same; times are rounded to
// nanoseconds in ROS's forms. Notes stand in comments, which JSON has not. Throws core::Error where
// the trajectory is not whole, the name of a joint or note is more than letters, digits, '_', '-',
// '.', '/', a note more than a line, or a time one that ROS's forms cannot tell from another.
std::string TrajectoryText(const JointTrajectory& trajectory, TrajectoryFormat format);

// Reads what TrajectoryText writes, and ROS's YAML with lists of one entry a line. Throws
// core::Error, naming `where` and the line or place: text that is cut off, no number, NaN, another
// count than there are joints, times that do not rise, an unknown member, more than 64 joints or
// 2,000,000 samples.
JointTrajectory ParseTrajectory(const std::string& text, TrajectoryFormat format,
                                const std::string& where);

// To and from a file of at most 1 GiB, in the format of its ending. Throws core::Error as above, or
// where the file cannot be read or written.
void WriteTrajectory(const std::filesystem::path& path, const JointTrajectory& trajectory);
JointTrajectory ReadTrajectory(const std::filesystem::path& path);

}  // namespace simwright::robot
