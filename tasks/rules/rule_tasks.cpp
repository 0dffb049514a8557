#include "tasks/rules/rule_tasks.h"

#include <algorithm>
#include <optional>
#include <set>

#include "core/error.h"
#include "core/parallel.h"
#include "tasks/layout.h"
#include "tasks/rules/affordances.h"
#include "tasks/rules/step.h"
#include "tasks/rules/task_candidate.h"
#include "tasks/task_names.h"
#include "tasks/verification/start_planning.h"
#include "tasks/verification/subtask_verifier.h"

namespace simwright::tasks {
namespace {

constexpr int kTasksPerObject = 5;
constexpr int kCandidatesPerTask = 4;  // some are infeasible
constexpr int kBatch = 64;             // candidates processed in parallel

// Returns the predicates that hold in the layout of a candidate.
PredicateSet InitialPredicates(const WorldModel& model, const TaskCandidate& candidate,
                               const WorldState& state) {
  PredicateSet predicates{{PredicateKind::kGripperEmpty}};
  for (int t : candidate.layout.objects) {
    const ArticulatedObject& object = model.objects[static_cast<std::size_t>(t)];
    for (std::size_t j = 0; j < object.joints.size(); ++j) {
      const bool away = state.joints[static_cast<std::size_t>(t)][j] != object.joints[j].rest();
      predicates.insert({away ? PredicateKind::kJointAway : PredicateKind::kJointAtRest, t, -1,
                         static_cast<int>(j)});
    }
    predicates.insert({PredicateKind::kFree, t});
    const auto supports =
        std::find_if(candidate.layout.supports.begin(), candidate.layout.supports.end(),
                     [&](const SupportRelation& one) { return one.object == t; });
    if (supports == candidate.layout.supports.end()) {
      predicates.insert({PredicateKind::kOnFloor, t});
    } else if (supports->receptacle >= 0) {
      predicates.insert({PredicateKind::kIn, t, supports->holder, supports->receptacle});
    } else {
      predicates.insert({PredicateKind::kOn, t, supports->holder});
      predicates.erase({PredicateKind::kFree, supports->holder});
    }
  }
  return predicates;
}

// The task of a candidate, or the reason why it was dropped.
struct Outcome {
  std::optional<Task> task;
  std::string dropped;
};

Outcome BuildTask(const WorldModel& model, const TaskCandidate& candidate, std::uint64_t seed,
                  std::uint64_t index) {
  core::Rng rng = core::StreamRng(seed, index);
  const std::optional<InitialState> start = PlanLayout(model, candidate.layout, rng);
  if (!start) return {std::nullopt, "no-layout"};
  WorldState state = StateOf(model, *start);
  PredicateSet predicates = InitialPredicates(model, candidate, state);
  const std::vector<Operator> plan =
      Plan(OperatorsFor(model, candidate.layout.objects), candidate.goals, &predicates);
  if (plan.empty()) return {std::nullopt, "no-plan"};
  Task task;
  task.source = "rules";
  for (int object : candidate.layout.objects) {
    task.assets.push_back(model.objects[static_cast<std::size_t>(object)].name);
  }
  SubtaskVerifier verifier(model);
  InitialState now = *start;
  std::set<std::string> names;  // repeated steps are numbered
  for (const Operator& one : plan) {
    const Step step = MakeStep(model, state, one);
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
    now = StartOfNextSubtask(model, state, now);
    state = StateOf(model, now);
  }
  const bool single = task.subtasks.size() == 1;
  task.name = single || candidate.name.empty() ? task.subtasks.back().name : candidate.name;
  task.description = single || candidate.description.empty() ? task.subtasks.back().description
                                                             : candidate.description;
  return {std::move(task), ""};
}

std::string DroppedText(const std::map<std::string, int>& dropped) {
  std::string text;
  for (const auto& [code, count] : dropped) {
    text += (text.empty() ? "" : ", ") + code + " " + std::to_string(count);
  }
  return text;
}

// Returns a finding for each object that no task uses: the gripper can do nothing with it, or every
// candidate was dropped.
core::Findings FindUnusedObjects(const WorldModel& model, const RuleTasks& generated) {
  std::set<std::string> used;
  for (const Task& task : generated.tasks) used.insert(task.assets.begin(), task.assets.end());
  core::Findings findings;
  for (const ArticulatedObject& object : model.objects) {
    if (used.contains(object.name)) continue;
    UnusableReason why = ExplainUnusable(object);
    if (why.sentence.empty()) {
      const std::string dropped = DroppedText(generated.dropped);
      why = dropped.empty()
                ? UnusableReason{"the tasks of other assets reach the requested count",
                                 "a larger --count"}
                : UnusableReason{
                      "no task with it passed verification; dropped: " + dropped,
                      "docs/tasks.md explains the codes; another --seed gives another layout"};
    }
    findings.push_back(
        {"no-task", core::Severity::kWarning, object.name, why.sentence, 0.0, why.remedy});
  }
  return findings;
}

RuleTasks Generate(const WorldModel& model, const RuleOptions& options, core::Progress* progress);

}  // namespace

bool RuleOptions::IsValid(std::string* error) const {
  if (count >= 0 && count <= 1'000'000) return true;
  if (error != nullptr) *error = "the number of tasks must be between 0 and 1000000";
  return false;
}

RuleTasks GenerateTasksByRules(const WorldModel& model, const RuleOptions& options,
                               core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "task generation");
  RuleTasks generated = Generate(model, options, progress);
  generated.findings = FindUnusedObjects(model, generated);
  return generated;
}

namespace {

RuleTasks Generate(const WorldModel& model, const RuleOptions& options, core::Progress* progress) {
  const int wanted =
      options.count > 0 ? options.count : kTasksPerObject * static_cast<int>(model.objects.size());
  core::Rng rng = core::StreamRng(options.seed, 0);
  const std::vector<TaskCandidate> candidates =
      GenerateCandidates(model, static_cast<std::size_t>(kCandidatesPerTask) * wanted, rng);
  RuleTasks result;
  std::set<std::string> names;
  if (progress != nullptr) progress->Stage("tasks", wanted);
  for (std::size_t first = 0; first < candidates.size(); first += kBatch) {
    const int batch = static_cast<int>(std::min<std::size_t>(kBatch, candidates.size() - first));
    std::vector<Outcome> outcomes(static_cast<std::size_t>(batch));
    core::ParallelFor(batch, [&](int i) {
      const std::size_t index = first + static_cast<std::size_t>(i);
      outcomes[static_cast<std::size_t>(i)] =
          BuildTask(model, candidates[index], options.seed, index + 1);
    });
    for (Outcome& one : outcomes) {
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
