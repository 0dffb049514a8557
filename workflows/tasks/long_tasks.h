#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "skills/skill_chain.h"
#include "tasks/language/whole_task.h"
#include "workflows/skills/skill_run.h"

namespace simwright::workflows {

// A task of several subtasks that demonstrates the benefit of decomposition.
struct LongTask {
  std::string name;   // cup_into_microwave
  std::string kinds;  // library kinds, separated by commas; one instance of each
  std::string task;   // the rules' name of the task
  std::string robot = "panda";
  std::uint64_t seed = 1;  // the instances' seed
};

const std::vector<LongTask>& LongTasks();

// Returns the long task of this name. Throws core::Error, listing the known names, if there is
// none.
const LongTask& LongTaskOf(const std::string& name);

// Makes the task's assets in folder/assets and folder/tasks.json with this one task, unless they
// exist, and returns that file. Throws core::Error.
std::filesystem::path MakeLongTask(const LongTask& task, const std::filesystem::path& folder,
                                   core::Progress* progress);

// Marks the subtasks whose success still holds at the end of successful chains: the goal of the
// task as a whole. (subtasks) Marks the last one alone if no chain has succeeded.
std::vector<bool> LastingSubtasks(const std::vector<RunSkill>& skills,
                                  const skills::ChainEvaluation& chain);

}  // namespace simwright::workflows
