#pragma once

#include <vector>

#include "tasks/language/answer_outline.h"
#include "tasks/task.h"

namespace simwright::tasks {

// Returns the tasks of an answer's outline, named by their titles as written; a name is empty where
// the answer gives none. A program belongs to the subtask or task named above it. Programs without
// a name above them are assigned in order to the entries of an earlier list. A subtask named
// without a program has an empty program.
std::vector<Task> TasksInOutline(const std::vector<OutlineEntry>& outline);

}  // namespace simwright::tasks
