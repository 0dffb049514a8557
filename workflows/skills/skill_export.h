#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "robot/limit_check.h"

namespace simwright::workflows {

enum class ExportFormat {
  kRos2,       // trajectory_msgs/JointTrajectory, one for the arm and one for the gripper, in YAML
               // or, for a file that ends in .json, in JSON
  kCsv,        // a table
  kRobomimic,  // HDF5
};

struct ExportRequest {
  std::filesystem::path run;     // a folder written by TrainTask
  std::filesystem::path output;  // a file, or a folder for several trajectories
  ExportFormat format = ExportFormat::kRos2;
  int episodes = 1;  // successful ones whose files reproduce the task
  std::uint64_t seed = 1;
  bool force = false;       // replaces an existing folder
  std::string joint_names;  // "panda", "fr3" or a file (robot::JointNamesFor); "": the robot's
  bool at_recorded_speed = false;  // else as fast as the limits and the task allow
};

// The worst demands of all motions on one joint.
struct JointMargins {
  robot::JointLimitReport worst;
  double deviation = 0.0;  // from the recording, rad or m
  bool slides = false;
};

struct ExportReport {
  std::filesystem::path output;
  int episodes = 0;              // written
  int tried = 0, succeeded = 0;  // rollouts
  int slowed = 0;           // trajectories that reproduce their task only below the limits' speed
  int closer = 0;           // trajectories that reproduce their task only closer to the recording
  core::Findings findings;  // omissions and their reasons
  // Only for trajectories:
  std::vector<JointMargins> joints;
  double seconds = 0.0;         // mean duration
  double stretch = 0.0;         // the largest ratio of a motion's duration to its recording's
  double least_stretch = 0.0;   // the smallest
  double tool_deviation = 0.0;  // m, the largest
};

// Runs the whole task until `episodes` episodes have succeeded and writes them: as motions, retimed
// to the robot's limits and checked, or as demonstrations. Each one is replayed from the exact text
// of its file, as Replay does, before it is written; one that does not reproduce its task is
// omitted and reported. Throws core::Error: for a file extension that does not match the format,
// wherever RecordSuccesses and MotionOf throw, and for a file or folder that cannot be written.
// Writes all files or none.
ExportReport Export(const ExportRequest& request, core::Progress* progress);

std::string ExportTable(const ExportReport& report);
std::string ExportJson(const ExportReport& report);

}  // namespace simwright::workflows
