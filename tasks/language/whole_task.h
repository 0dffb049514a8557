#pragma once

#include <string>
#include <vector>

#include "tasks/task.h"

namespace simwright::tasks {

// What an undecomposed task takes of its subtasks.
struct WholeTaskParts {
  std::vector<bool> rewarded;  // (subtasks) whose rewards are added up
  std::vector<bool> required;  // (subtasks) whose success, all at once, is the task's
};

// `task` as one of a single subtask called `name`: it starts as the first one does, and its program
// holds theirs as functions. Where several ask for a goal, get_goal_pose gives the last one's and
// the others' are written into the program. Throws core::Error, naming the task, where `parts` are
// of another length or hold nothing rewarded or required, or where a program's reward function
// cannot be told.
Task WholeTask(const Task& task, const WholeTaskParts& parts, const std::string& name);

}  // namespace simwright::tasks
