#pragma once

#include <string>
#include <vector>

#include "core/finding.h"
#include "llm/chat_model.h"
#include "tasks/task.h"

namespace simwright::tasks {

// The question for `count` tasks in the scene that `description` tells of (DescribeScene), in
// Gen2Sim's four sections: assets, instructions with the environment's functions, an example of a
// task with its subtasks, and their reward functions. `have` names tasks that are there already.
llm::ChatRequest TaskQuestion(const std::string& description, int count,
                              const std::vector<std::string>& have);

// The question that follows an answer without any task.
std::string AskForTasksAgain();

// The question for the whole reward function of a subtask again, with what is wrong with it, lines
// and carets included. An empty program is asked for as a missing one.
llm::ChatRequest RepairQuestion(const std::string& description, const Task& task,
                                const Subtask& subtask, const core::Findings& findings);

// What is said to a repaired function that is wrong again; `answered` is the program read from the
// answer, empty where there was none, and `before` the one it should mend.
std::string RepairAgain(const std::string& answered, const std::string& before,
                        const core::Findings& findings);

}  // namespace simwright::tasks
