#pragma once

#include <string>

#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::pipeline {

// The tasks as one HTML page without scripts or outside files: a table of contents, and each task
// with its drawing (pipeline/task_drawing.h), its programs, findings and earlier attempts.
std::string TaskPage(const tasks::TaskSet& set, const tasks::SceneModel& model);

}  // namespace simwright::pipeline
