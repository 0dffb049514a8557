#pragma once

#include <string>

#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// The task as a picture, an <svg> element: to the left its start seen from above (the robot, its
// reach, every thing's outline), to the right its subtasks in order, each with what makes it done;
// red where one is not sound. Things that `model` does not have are left out.
std::string TaskDrawing(const tasks::Task& task, const tasks::SceneModel& model);

}  // namespace simwright::pipeline
