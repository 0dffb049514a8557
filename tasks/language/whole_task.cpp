#include "tasks/language/whole_task.h"

#include <algorithm>
#include <regex>

#include "core/error.h"
#include "tasks/language/answer_text.h"
#include "tasks/language/program_blocks.h"

namespace simwright::tasks {
namespace {

constexpr const char* kIndent = "    ";

const std::regex& GoalCall() {
  static const std::regex call(R"((\w+)\.get_goal_(pose|position)\([^()]*\))");
  return call;
}

bool AsksForGoal(const Subtask& subtask) {
  return subtask.goal && std::regex_search(subtask.program, GoalCall());
}

// Returns `program` with its goal as a constant.
std::string WithGoal(const std::string& program, const Eigen::Vector3d& goal) {
  char point[96];
  std::snprintf(point, sizeof(point), "[%.9g, %.9g, %.9g]", goal.x(), goal.y(), goal.z());
  return std::regex_replace(program, GoalCall(),
                            std::string("torch.tensor(") + point +
                                ", device=$1.device).unsqueeze(0).repeat($1.num_envs, 1)");
}

// Returns the subtask's program inside a function `name`, which keeps its names local.
std::string AsFunction(const Subtask& subtask, const std::string& name, bool goal_of_task) {
  const BlockPrograms found = SplitProgramBlock(LinesOf(subtask.program));
  if (found.programs.size() != 1 || found.programs.front().function.empty()) {
    throw core::Error("its program does not hold exactly one reward function",
                      "subtask " + subtask.name);
  }
  const bool replaced = AsksForGoal(subtask) && !goal_of_task;
  const std::string program = replaced ? WithGoal(subtask.program, *subtask.goal) : subtask.program;
  std::string text = "def " + name + "(env):\n";
  for (const std::string& line : LinesOf(program)) {
    text += line.empty() ? "\n" : kIndent + line + "\n";
  }
  return text + kIndent + "return " + found.programs.front().function + "(env)\n\n";
}

// Returns the conjunction: "a", "torch.logical_and(a, b)", "torch.logical_and(torch.logical_and(a,
// b), c)" ...
std::string All(const std::vector<std::string>& flags) {
  std::string text = flags.front();
  for (size_t i = 1; i < flags.size(); ++i) {
    text = "torch.logical_and(" + text + ", " + flags[i] + ")";
  }
  return text;
}

void RequireParts(const Task& task, const SubtaskSelection& parts) {
  const auto any = [](const std::vector<bool>& flags) {
    return std::find(flags.begin(), flags.end(), true) != flags.end();
  };
  const size_t count = task.subtasks.size();
  if (parts.rewarded.size() != count || parts.required.size() != count) {
    throw core::Error("has " + std::to_string(count) + " subtasks, not " +
                          std::to_string(parts.rewarded.size()) + " and " +
                          std::to_string(parts.required.size()),
                      "task " + task.name);
  }
  if (!any(parts.rewarded) || !any(parts.required)) {
    throw core::Error("no reward or no success condition of it is selected", "task " + task.name);
  }
}

}  // namespace

Task MergeSubtasks(const Task& task, const SubtaskSelection& parts, const std::string& name) {
  RequireParts(task, parts);
  const auto taken = [&](size_t k) { return parts.rewarded[k] || parts.required[k]; };
  size_t last_goal = task.subtasks.size();
  for (size_t k = 0; k < task.subtasks.size(); ++k) {
    if (taken(k) && AsksForGoal(task.subtasks[k])) last_goal = k;
  }
  Subtask whole;
  whole.name = name;
  whole.description = task.description;
  whole.start = task.subtasks.front().start;
  std::string calls, rewards;
  std::vector<std::string> flags;
  for (size_t k = 0; k < task.subtasks.size(); ++k) {
    if (!taken(k)) continue;
    const std::string number = std::to_string(k + 1);
    whole.program += AsFunction(task.subtasks[k], "subtask_" + number, k == last_goal);
    calls += kIndent + ("gain_" + number) + ", done_" + number + " = subtask_" + number + "(env)\n";
    if (parts.rewarded[k]) rewards += (rewards.empty() ? "gain_" : " + gain_") + number;
    if (!parts.required[k]) continue;
    flags.push_back("done_" + number);
    whole.success += (whole.success.empty() ? "" : ", and ") + task.subtasks[k].success;
  }
  if (last_goal < task.subtasks.size()) whole.goal = task.subtasks[last_goal].goal;
  whole.program += "def compute_reward(env):\n" + calls + kIndent + "return " + rewards + ", " +
                   All(flags) + "\n";
  Task one = task;
  one.name = name;
  one.subtasks = {std::move(whole)};
  one.findings.clear();
  return one;
}

}  // namespace simwright::tasks
