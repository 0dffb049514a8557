#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "llm/chat_model.h"
#include "tasks/task.h"

namespace simwright::tasks {

// Returns the prompt that asks for `count` tasks in the scene described by `description` (see
// DescribeScene), in Gen2Sim's four sections: assets, instructions with the environment's
// functions, an example of a task with its subtasks, and their reward functions. `have` names the
// tasks that already exist.
llm::ChatRequest TaskQuestion(const std::string& description, int count,
                              const std::vector<std::string>& have);

// Returns the follow-up prompt after an answer without any task.
std::string RetryQuestion();

// Returns the prompt that asks for a subtask's whole reward function again and lists its findings
// with source lines and carets. An empty program is requested as a missing one.
llm::ChatRequest RepairQuestion(const std::string& description, const Task& task,
                                const Subtask& subtask, const core::Findings& findings);

// Returns the follow-up prompt after a repaired function that is still wrong. `answered` is the
// program read from the answer, empty where there was none; `before` is the program that it should
// have repaired.
std::string RepairRetryQuestion(const std::string& answered, const std::string& before,
                                const core::Findings& findings);

}  // namespace simwright::tasks
