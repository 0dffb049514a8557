#pragma once

#include <string>

#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::workflows {

// Draws the task as an <svg> element: on the left its start from above (the robot, its reach, the
// outline of every object), on the right its subtasks in order, each with its success condition;
// red if a subtask is not valid. Objects that are not in `model` are omitted.
std::string TaskDrawing(const tasks::Task& task, const tasks::WorldModel& model);

}  // namespace simwright::workflows
