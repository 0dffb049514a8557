#pragma once

#include <string>
#include <vector>

#include "tasks/task.h"

namespace simwright::tasks {

// The selection of subtask rewards and success conditions that makes up an undecomposed task.
struct SubtaskSelection {
  std::vector<bool> rewarded;  // (subtasks) whose rewards are summed
  std::vector<bool> required;  // (subtasks) whose success conditions must hold simultaneously
};

// Returns `task` as a task with a single subtask called `name`. It starts where the first subtask
// starts, and its program holds the subtasks' programs as functions. If several subtasks have a
// goal, get_goal_pose returns the last one's and the other goals are constants in the program.
// Throws core::Error, naming the task, if `parts` has another length or selects no reward or no
// success condition, or if a program's reward function cannot be determined.
Task MergeSubtasks(const Task& task, const SubtaskSelection& parts, const std::string& name);

}  // namespace simwright::tasks
