#pragma once

#include <functional>

#include "core/finding.h"
#include "tasks/task.h"

namespace simwright::tasks {

// Verifies a subtask of `task` and returns its findings in the order of its program; places are
// "line:column" or empty. Fills `subtask->start`. The preceding subtasks must have been verified.
using VerifySubtask = std::function<core::Findings(const Task& task, Subtask* subtask)>;

}  // namespace simwright::tasks
