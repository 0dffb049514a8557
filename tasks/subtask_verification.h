#pragma once

#include <functional>

#include "core/finding.h"
#include "tasks/task.h"

namespace simwright::tasks {

// What is wrong with a subtask of `task`, in the order of its program; places are "line:column" or
// empty. Fills `subtask->start`; the subtasks before it have been verified.
using VerifySubtask = std::function<core::Findings(const Task& task, Subtask* subtask)>;

}  // namespace simwright::tasks
