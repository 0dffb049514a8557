#pragma once

#include <string>

#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::workflows {

// Returns the tasks as one HTML page without scripts or external files: a table of contents, and
// each task with its drawing (pipeline/task_drawing.h), programs, findings and earlier attempts.
std::string TaskPage(const tasks::TaskSet& set, const tasks::WorldModel& model);

}  // namespace simwright::workflows
