#pragma once

#include <string>
#include <vector>

#include "rl/policy.h"
#include "tasks/task.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_suite.h"

namespace simwright::workflows {

// A subtask of a file that a shipped policy can act in.
struct TakenSubtask {
  std::string task, subtask;  // names
};

// A task of the file without a subtask for the policy, and the reason as a sentence.
struct SkippedTask {
  std::string task, reason;
};

// The subtasks of a file that belong to a shipped skill.
struct SkillMatch {
  tasks::TaskSet set;  // one task per subtask, with this subtask alone
  std::vector<TakenSubtask> taken;
  std::vector<SkippedTask> skipped;
};

// Returns true if the subtask's name says that the cell's skill does it to one of the task's
// assets: the cell's verb, the asset's name, and the cell's part, numbered or not.
bool NamesSkill(const SuiteCell& cell, const tasks::Task& task, const tasks::Subtask& subtask);

// Chooses the subtasks of `set`, read from `file`, for the policy of a cell.
//
// Without `patterns`: all subtasks that name the skill (NamesSkill) and whose asset is of the
// cell's category. With `patterns` (names of tasks, or patterns as in ChooseTasks): of the tasks
// that match one, the subtasks that name the skill, whatever the category; a task whose full name
// is given and that has a single subtask is taken without regard to the subtask's name. In all
// cases the policy must have the observation and action size of the subtask, the programs of all
// must read the same inputs, and equal subtasks are taken once.
//
// Throws core::Error, listing what the file has, if no subtask is left, or as ChooseTasks does.
SkillMatch MatchSkill(const SuiteCell& cell, const rl::Policy& policy, const tasks::TaskSet& set,
                      const std::vector<std::string>& patterns, const std::string& file);

}  // namespace simwright::workflows
