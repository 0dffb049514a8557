#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "llm/chat_model.h"
#include "tasks/task.h"

namespace simwright::pipeline {

struct TasksRequest {
  std::vector<std::string> assets;  // each PATH or NAME=PATH (pipeline/task_assets.h)
  std::filesystem::path output;     // tasks.json; the page lies beside it, with the ending .html
  int count = 0;                    // of tasks; 0: five an asset by rules, 8 of a language model
  std::uint64_t seed = 1;
  bool force = false;               // replace an output that exists
  llm::ChatModel* model = nullptr;  // null: by rules
};

struct TasksReport {
  tasks::TaskSet set;
  std::filesystem::path file, page;
  core::Findings findings;             // of the assets, the answers, the whole
  std::map<std::string, int> dropped;  // ideas of the rules that came to nothing, by reason
  int repaired = 0;                    // subtasks that a language model mended

  // There are tasks, and each is sound.
  bool passed() const;
};

// Makes tasks, verifies every subtask, and writes tasks.json and its page: all that was made, sound
// or not. Throws core::Error where the assets cannot be read, the output exists and `force` is not
// set, or a language model cannot be asked at all.
TasksReport MakeTasks(const TasksRequest& request, core::Progress* progress);

// A table for a terminal: task, subtasks, findings, repairs; below each what was found in it.
std::string TasksTable(const TasksReport& report);
std::string TasksJson(const TasksReport& report);

}  // namespace simwright::pipeline
