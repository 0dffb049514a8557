#pragma once

#include <filesystem>

#include "robot/joint_names.h"
#include "robot/joint_trajectory.h"

namespace simwright::pipeline {

// A motion on disk: in ROS's forms a message for each controller, the arm's in the file that is
// named and the gripper's beside it; in a table all joints.

// "pick.gripper.yaml" of "pick.yaml".
std::filesystem::path GripperBeside(const std::filesystem::path& motion);
// Where the notes of a motion in JSON lie, whose form has no room for them: "pick.notes.json".
std::filesystem::path NotesBeside(const std::filesystem::path& motion);
// Whether a file is one of these two, no motion of its own.
bool LiesBesideMotion(const std::filesystem::path& file);

// Writes `trajectory`, whose last joint is the gripper's, under `names`, in the format of the
// file's ending. A note says which joints of the robot they are. Throws core::Error as
// robot::WriteTrajectory.
void WriteMotion(const robot::JointTrajectory& trajectory, const std::filesystem::path& file,
                 const robot::JointNames& names = {});

// Reads a motion back, under the robot's own names. Throws core::Error as robot::ReadTrajectory, or
// where the gripper's file or the notes are missing or not of this motion.
robot::JointTrajectory ReadMotion(const std::filesystem::path& file);

}  // namespace simwright::pipeline
