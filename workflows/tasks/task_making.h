#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "llm/chat_model.h"
#include "tasks/task.h"

namespace simwright::workflows {

struct TasksRequest {
  std::vector<std::string> assets;  // each PATH or NAME=PATH (pipeline/task_assets.h)
  std::filesystem::path output;     // tasks.json; the page beside it ends in .html
  int count = 0;                    // 0: 5 per asset by rules, 8 by a language model
  std::uint64_t seed = 1;
  bool force = false;                                        // replaces an existing output
  llm::ChatModel* model = nullptr;                           // null: generates by rules
  std::optional<tasks::InitialState> layout = std::nullopt;  // tasks::RuleOptions::layout
};

struct TasksReport {
  tasks::TaskSet set;
  std::filesystem::path file, page;
  core::Findings findings;             // about the assets, the answers and the task set
  std::map<std::string, int> dropped;  // rejected task candidates, by reason
  int repaired = 0;                    // subtasks that a language model repaired

  // Returns true if there are tasks and all are valid.
  bool passed() const;
};

// Generates tasks, verifies every subtask, and writes tasks.json and its page with all tasks, valid
// or not. Throws core::Error if the assets cannot be read, the output exists and `force` is not
// set, or a language model is not reachable.
TasksReport MakeTasks(const TasksRequest& request, core::Progress* progress);

// Formats a table for a terminal: task, subtasks, findings and repairs, with the findings below
// each.
std::string TasksTable(const TasksReport& report);
std::string TasksJson(const TasksReport& report);

}  // namespace simwright::workflows
