#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/progress.h"
#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::tasks {

struct RuleOptions {
  int count = 0;  // of tasks; 0: five for each thing, which shows every kind at least once
  std::uint64_t seed = 1;

  bool IsValid(std::string* error) const;
};

struct RuleTasks {
  std::vector<Task> tasks;  // every subtask verified, without an error or a warning
  int tried = 0;            // ideas looked at, until there were enough
  // Why ideas were dropped: codes of findings, "no-plan", "no-layout", and how often.
  std::map<std::string, int> dropped;
  // "no-task", a warning for each thing that is in no task, with the reason.
  core::Findings findings;
};

// Tasks by rules alone: what can be opened, turned, pressed, picked up, pushed, stood on, put into,
// taken out and poured, and what follows from it by preconditions and effects (rules/planner.h).
// In parallel; the same tasks for a seed whatever the thread count. Throws core::Error for invalid
// options, core::Cancelled after Ctrl-C.
RuleTasks GenerateTasksByRules(const SceneModel& model, const RuleOptions& options,
                               core::Progress* progress = nullptr);

}  // namespace simwright::tasks
