#pragma once

#include <vector>

#include "tasks/language/answer_outline.h"
#include "tasks/task.h"

namespace simwright::tasks {

// The tasks of an answer's outline, with titles for names as they stand there, empty where there
// are none. A program belongs to the subtask or task that is named above it; programs above which
// nothing is named belong in order to what a list named before. What is named without a program
// has an empty one.
std::vector<Task> TasksOf(const std::vector<OutlineEntry>& outline);

}  // namespace simwright::tasks
