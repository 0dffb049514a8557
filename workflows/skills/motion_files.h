#pragma once

#include <filesystem>

#include "robot/joint_names.h"
#include "robot/joint_trajectory.h"

namespace simwright::workflows {

// A motion on disk. ROS formats have one message per controller: the arm's in the named file and
// the gripper's beside it. A table has all joints.

// Returns the path of the gripper's file, "pick.gripper.yaml" for "pick.yaml".
std::filesystem::path GripperBeside(const std::filesystem::path& motion);
// Returns the path of the metadata of a motion in JSON, a format without room for it:
// "pick.notes.json".
std::filesystem::path MetadataFileBeside(const std::filesystem::path& motion);
// Returns true if the file is a gripper or metadata file and not a motion itself.
bool IsMotionSideFile(const std::filesystem::path& file);

// Writes `trajectory`, whose last joint is the gripper's, under `names`, in the format of the
// file's extension. The metadata says which joints of the robot they are. Throws core::Error as
// robot::WriteTrajectory does.
void WriteMotion(const robot::JointTrajectory& trajectory, const std::filesystem::path& file,
                 const robot::JointNames& names = {});

// Reads a motion back under the robot's own joint names. Throws core::Error as
// robot::ReadTrajectory does, or if the gripper's file or the metadata is missing or belongs to
// another motion.
robot::JointTrajectory ReadMotion(const std::filesystem::path& file);

}  // namespace simwright::workflows
