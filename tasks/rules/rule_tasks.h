#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::tasks {

struct RuleOptions {
  int count = 0;  // number of tasks; 0: five per object, which covers every kind at least once
  std::uint64_t seed = 1;
  // The state in which all tasks start, with the robot and a placement for each object; none: each
  // task has a layout of its own. Tasks whose objects are out of reach, which need other joint
  // positions or objects in or on others, or whose goal is occupied are then dropped.
  std::optional<InitialState> layout = std::nullopt;

  bool IsValid(std::string* error) const;
};

struct RuleTasks {
  std::vector<Task> tasks;  // tasks whose subtasks are all verified without a finding
  int tried = 0;            // candidates tried until there were enough tasks
  // The reasons for which candidates were dropped (finding codes, "no-plan", "no-layout"; with a
  // given layout "not-in-layout", "out-of-reach", "goal-occupied") and their counts.
  std::map<std::string, int> dropped;
  // "no-task": a warning, with the reason, for each object that no task uses.
  core::Findings findings;
};

// Generates tasks by rules alone: objects that can be opened, turned, pressed, picked up, pushed,
// stood on, put into, taken out and poured, and combinations that follow by preconditions and
// effects (rules/planner.h). Runs in parallel; a seed gives the same tasks for any thread count.
// Throws core::Error for invalid options, core::Cancelled after Ctrl-C.
RuleTasks GenerateTasksByRules(const WorldModel& model, const RuleOptions& options,
                               core::Progress* progress = nullptr);

}  // namespace simwright::tasks
