#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"

namespace simwright::workflows {

struct TaskWorldExportRequest {
  std::filesystem::path source;  // a folder written by TrainTask, or a tasks.json
  std::string task;              // its name; may be empty for a folder: its first
  std::string subtask;           // empty: the task's first
  std::string robot = "panda";   // for a tasks.json (SkillRun::robot)
  std::string format;            // "mjcf", "sdf", "drake", "usd"
  // The seed of a start that is sampled as in an evaluation; none: the start that the subtask
  // describes.
  std::optional<std::uint64_t> start_seed;
  std::filesystem::path output;  // a folder
  bool force = false;            // replaces an existing folder
};

struct TaskWorldExportReport {
  std::filesystem::path output;
  std::string file;                 // the world, in `output`
  std::string task, subtask;        // names
  std::vector<std::string> bodies;  // names, the robot's first
  int joints = 0;                   // that move
  double mass = 0.0;                // kg, of all bodies
  core::Findings findings;
};

// Writes the robot, furniture and objects of a task at its start as one world (TaskWorld):
// world.xml (MJCF), world.sdf, or world.dmd.yaml with one SDF per body (Drake), and the meshes
// beside it; or world.usda, which holds the meshes. Throws core::Error for an unknown task, subtask
// or format, an asset that is missing or has changed, and an existing output.
TaskWorldExportReport ExportTaskWorld(const TaskWorldExportRequest& request);

std::string TaskWorldTable(const TaskWorldExportReport& report);
std::string TaskWorldJson(const TaskWorldExportReport& report);

}  // namespace simwright::workflows
