#pragma once

#include <string_view>
#include <vector>

#include "tasks/task.h"

namespace simwright::tasks {

// The tasks that JSON in an answer holds, with titles for names: objects and arrays of tasks, of
// subtasks and of reward functions, under any of the usual keys; programs as text or as arrays of
// lines. Line breaks inside of texts, comments, commas at an end and Python's triple quotes are
// forgiven. `answer` as PlainAnswer gives it.
std::vector<Task> TasksInJson(std::string_view answer);

}  // namespace simwright::tasks
