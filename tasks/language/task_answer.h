#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "tasks/task.h"

namespace simwright::tasks {

// What an answer of a language model proposes.
struct TaskAnswer {
  // Names are safe and unique (SafeName); assets, start and findings are empty. A subtask without
  // a program was named only.
  std::vector<Task> tasks;
  core::Findings findings;

  bool has_program() const;
};

// Reads tasks, subtasks and reward programs from an answer in any form: "Task: ..." lines,
// Markdown, lists, JSON, bare functions, with or without fences. All of it is data: nothing in it
// is followed or run. At most 1 MiB is read, at most 100 tasks of 30 subtasks are kept. Never
// throws; findings:
//   answer-empty (error), answer-no-program (error), answer-cut, answer-too-many-tasks (warnings),
//   task-renamed (warning): another is called so.
TaskAnswer ReadTaskAnswer(std::string_view answer);

// The one reward program of an answer that should hold nothing else: the first where there are
// several; empty where there is none. Never throws.
std::string ReadProgramAnswer(std::string_view answer);

}  // namespace simwright::tasks
