#pragma once

#include <string_view>
#include <vector>

#include "tasks/task.h"

namespace simwright::tasks {

// Returns the tasks in the JSON of an answer, named by their titles. The JSON may hold objects and
// arrays of tasks, of subtasks and of reward functions under any of the usual keys, and programs as
// text or as arrays of lines. The parser tolerates line breaks inside strings, comments, trailing
// commas and Python's triple quotes. `answer` is text as PlainAnswer returns it.
std::vector<Task> TasksInJson(std::string_view answer);

}  // namespace simwright::tasks
