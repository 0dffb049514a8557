#include "tasks/rules/rule_tasks.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "tasks/layout.h"
#include "tasks/rules/affordances.h"
#include "tasks/rules/idea.h"
#include "tasks/rules/step.h"
#include "tasks/task_names.h"
#include "tasks/verification/start_planning.h"
#include "tasks/verification/subtask_verifier.h"

namespace simwright::tasks {
namespace {

constexpr int kTasksAThing = 5;
constexpr int kIdeasATask = 4;  // some are not possible
constexpr int kBatch = 64;      // ideas worked out side by side

// What holds in the layout of an idea, as facts.
Facts FactsAt(const SceneModel& model, const Idea& idea, const SceneState& state) {
  Facts facts{{FactKind::kHandEmpty}};
  for (int t : idea.layout.things) {
    const Thing& thing = model.things[static_cast<std::size_t>(t)];
    for (std::size_t j = 0; j < thing.joints.size(); ++j) {
      const bool away = state.joints[static_cast<std::size_t>(t)][j] != thing.joints[j].rest();
      facts.insert(
          {away ? FactKind::kJointAway : FactKind::kJointAtRest, t, -1, static_cast<int>(j)});
    }
    facts.insert({FactKind::kFree, t});
    const auto resting = std::find_if(idea.layout.resting.begin(), idea.layout.resting.end(),
                                      [&](const Resting& one) { return one.thing == t; });
    if (resting == idea.layout.resting.end()) {
      facts.insert({FactKind::kOnFloor, t});
    } else if (resting->cavity >= 0) {
      facts.insert({FactKind::kIn, t, resting->holder, resting->cavity});
    } else {
      facts.insert({FactKind::kOn, t, resting->holder});
      facts.erase({FactKind::kFree, resting->holder});
    }
  }
  return facts;
}

// The task of an idea, or why there is none.
struct Worked {
  std::optional<Task> task;
  std::string dropped;
};

Worked WorkOut(const SceneModel& model, const Idea& idea, std::uint64_t seed, std::uint64_t index) {
  core::Rng rng = core::StreamRng(seed, index);
  const std::optional<InitialState> start = LayOut(model, idea.layout, rng);
  if (!start) return {std::nullopt, "no-layout"};
  SceneState state = StateOf(model, *start);
  Facts facts = FactsAt(model, idea, state);
  const std::vector<Operator> plan =
      Plan(OperatorsFor(model, idea.layout.things), idea.goals, &facts);
  if (plan.empty()) return {std::nullopt, "no-plan"};
  Task task;
  task.source = "rules";
  for (int thing : idea.layout.things) {
    task.assets.push_back(model.things[static_cast<std::size_t>(thing)].name);
  }
  SubtaskVerifier verifier(model);
  InitialState now = *start;
  std::set<std::string> names;  // what is done twice is numbered
  for (const Operator& one : plan) {
    const Step step = StepOf(model, state, one);
    Subtask subtask;
    subtask.name = UniqueName(step.name, &names);
    subtask.description = step.description;
    subtask.program = step.program;
    subtask.success = step.success;
    subtask.start = now;
    subtask.goal = step.goal;
    subtask.findings = verifier.Verify(task, &subtask);
    if (!subtask.findings.empty()) return {std::nullopt, subtask.findings[0].code};
    task.subtasks.push_back(std::move(subtask));
    state.goal = step.goal.value_or(Eigen::Vector3d::Zero());
    state = MakeMotion(model, state, {step.action}).states.back();
    now = StartFrom(model, state, now);
    state = StateOf(model, now);
  }
  const bool single = task.subtasks.size() == 1;
  task.name = single || idea.name.empty() ? task.subtasks.back().name : idea.name;
  task.description =
      single || idea.description.empty() ? task.subtasks.back().description : idea.description;
  return {std::move(task), ""};
}

std::string DroppedText(const std::map<std::string, int>& dropped) {
  std::string text;
  for (const auto& [code, count] : dropped) {
    text += (text.empty() ? "" : ", ") + code + " " + std::to_string(count);
  }
  return text;
}

// What is in no task, and why: nothing that a hand does with it, or no idea that held.
core::Findings WithoutTask(const SceneModel& model, const RuleTasks& made) {
  std::set<std::string> used;
  for (const Task& task : made.tasks) used.insert(task.assets.begin(), task.assets.end());
  core::Findings findings;
  for (const Thing& thing : model.things) {
    if (used.contains(thing.name)) continue;
    NoUse why = WhyOfNoUse(thing);
    if (why.sentence.empty()) {
      const std::string dropped = DroppedText(made.dropped);
      why = dropped.empty()
                ? NoUse{"other assets took up the count of tasks", "a larger --count"}
                : NoUse{"no task with it held on verification; dropped: " + dropped,
                        "docs/tasks.md says what the codes mean; another --seed lays out anew"};
    }
    findings.push_back(
        {"no-task", core::Severity::kWarning, thing.name, why.sentence, 0.0, why.remedy});
  }
  return findings;
}

RuleTasks Generate(const SceneModel& model, const RuleOptions& options, core::Progress* progress);

}  // namespace

bool RuleOptions::IsValid(std::string* error) const {
  if (count >= 0 && count <= 1'000'000) return true;
  if (error != nullptr) *error = "the count of tasks must lie between 0 and 1000000";
  return false;
}

RuleTasks GenerateTasksByRules(const SceneModel& model, const RuleOptions& options,
                               core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "task generation");
  RuleTasks made = Generate(model, options, progress);
  made.findings = WithoutTask(model, made);
  return made;
}

namespace {

RuleTasks Generate(const SceneModel& model, const RuleOptions& options, core::Progress* progress) {
  const int wanted =
      options.count > 0 ? options.count : kTasksAThing * static_cast<int>(model.things.size());
  core::Rng rng = core::StreamRng(options.seed, 0);
  const std::vector<Idea> ideas =
      ThinkOfTasks(model, static_cast<std::size_t>(kIdeasATask) * wanted, rng);
  RuleTasks result;
  std::set<std::string> names;
  if (progress != nullptr) progress->Stage("tasks", wanted);
  for (std::size_t first = 0; first < ideas.size(); first += kBatch) {
    const int batch = static_cast<int>(std::min<std::size_t>(kBatch, ideas.size() - first));
    std::vector<Worked> worked(static_cast<std::size_t>(batch));
    core::ParallelFor(batch, [&](int i) {
      const std::size_t index = first + static_cast<std::size_t>(i);
      worked[static_cast<std::size_t>(i)] = WorkOut(model, ideas[index], options.seed, index + 1);
    });
    for (Worked& one : worked) {
      if (static_cast<int>(result.tasks.size()) == wanted) return result;
      ++result.tried;
      if (!one.task) {
        ++result.dropped[one.dropped];
        continue;
      }
      if (!names.insert(one.task->name).second) {
        ++result.dropped["same-name"];
        continue;
      }
      result.tasks.push_back(std::move(*one.task));
      if (progress != nullptr) progress->Advance();
    }
  }
  return result;
}

}  // namespace

}  // namespace simwright::tasks
