#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "tasks/task.h"

namespace simwright::tasks {

// The tasks that a language model's answer proposes.
struct TaskAnswer {
  // The tasks read from the answer. Names are safe and unique (SafeName); assets, start and
  // findings are empty. A subtask without a program was only named in the answer.
  std::vector<Task> tasks;
  core::Findings findings;

  bool has_program() const;
};

// Reads tasks, subtasks and reward programs from an answer in any form: "Task: ..." lines,
// Markdown, lists, JSON, bare functions, with or without fences. The answer is treated as data: no
// instruction in it is followed and no code is run. Reads at most 1 MiB and keeps at most 100 tasks
// of 30 subtasks. Never throws. Findings:
//   answer-empty (error), answer-no-program (error), answer-cut, answer-too-many-tasks (warnings),
//   task-renamed (warning): another task already has the name.
TaskAnswer ReadTaskAnswer(std::string_view answer);

// Returns the reward program of an answer that should hold exactly one: the first where there are
// several, empty where there is none. Never throws.
std::string ReadProgramAnswer(std::string_view answer);

}  // namespace simwright::tasks
