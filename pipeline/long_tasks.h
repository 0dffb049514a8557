#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "pipeline/skill_run.h"
#include "rl/chain.h"
#include "tasks/language/whole_task.h"

namespace simwright::pipeline {

// A task of several subtasks that shows what decomposing it is worth.
struct LongTask {
  std::string name;   // cup_into_microwave
  std::string kinds;  // of the library, separated by commas; one instance of each
  std::string task;   // as the rules call it
  std::string robot = "panda";
  std::uint64_t seed = 1;  // of the instances
};

const std::vector<LongTask>& LongTasks();

// Throws core::Error, listing those that are there.
const LongTask& LongTaskOf(const std::string& name);

// Makes its assets into folder/assets and folder/tasks.json with this one task, unless they are
// there; returns that file. Throws core::Error.
std::filesystem::path MakeLongTask(const LongTask& task, const std::filesystem::path& folder,
                                   core::Progress* progress);

// Which subtasks' success still holds where chains that succeeded have ended: what the task as a
// whole is for. (subtasks) Where none has succeeded, the last one alone.
std::vector<bool> LastingSubtasks(const std::vector<RunSkill>& skills,
                                  const rl::ChainEvaluation& chain);

}  // namespace simwright::pipeline
