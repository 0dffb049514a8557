#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "robot/limit_check.h"

namespace simwright::pipeline {

enum class ExportFormat {
  kRos2,       // trajectory_msgs/JointTrajectory, one of the arm and one of the gripper, YAML or, of
               // a file that ends in .json, JSON
  kCsv,        // a table
  kRobomimic,  // HDF5
};

struct ExportRequest {
  std::filesystem::path run;     // a folder that TrainTask wrote
  std::filesystem::path output;  // a file; of several trajectories a folder
  ExportFormat format = ExportFormat::kRos2;
  int episodes = 1;  // that succeed, and whose files do the task again
  std::uint64_t seed = 1;
  bool force = false;  // a folder that is there is replaced
  std::string joint_names;  // "panda", "fr3" or a file (robot::JointNamesFor); "": the robot's
  bool at_recorded_pace = false;  // else as fast as limits and the task allow
};

// What the motions ask of one joint: the worst of all of them.
struct JointMargins {
  robot::JointLimitReport worst;
  double deviation = 0.0;  // rad or m, from what was recorded
  bool slides = false;
};

struct ExportReport {
  std::filesystem::path output;
  int episodes = 0;              // written
  int tried = 0, succeeded = 0;  // rollouts
  int slowed = 0;  // trajectories that did their task again only at a pace below the limits'
  int closer = 0;  // trajectories that did their task again only closer to what was recorded
  core::Findings findings;  // what was left out, and why
  // Of trajectories alone:
  std::vector<JointMargins> joints;
  double seconds = 0.0;         // mean length
  double stretch = 0.0;         // the largest: a motion's length over its recording's
  double tool_deviation = 0.0;  // m, the largest
};

// Runs the whole task until so many episodes have succeeded and writes them: as motions retimed to
// the robot's limits and checked, or as demonstrations. Each is repeated before it is written, as
// Replay does it, from the very text of its file: one that does not do its task again is left out,
// and said. Throws core::Error: an ending that is not the format's, RecordSuccesses, MotionOf, a
// file or folder that cannot be written. All or nothing is written.
ExportReport Export(const ExportRequest& request, core::Progress* progress);

std::string ExportTable(const ExportReport& report);
std::string ExportJson(const ExportReport& report);

}  // namespace simwright::pipeline
