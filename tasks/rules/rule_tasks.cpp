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

// Returns the reason why a candidate cannot start in the given layout; empty: it can.
std::string LayoutObstacle(const WorldModel& model, const InitialState& layout,
                           const TaskCandidate& candidate) {
  if (!candidate.layout.supports.empty() || !candidate.layout.joints.empty()) {
    return "not-in-layout";
  }
  const WorldState state = StateOf(model, layout);
  for (const int object : candidate.layout.objects) {
    if (model.objects[static_cast<std::size_t>(object)].articulated()) continue;
    const Eigen::Vector3d middle = WorldAabb(model, state, object).center();
    if (!IsPointReachable(layout.world_from_robot, middle, -Eigen::Vector3d::UnitZ())) {
      return "out-of-reach";
    }
  }
  for (const auto& [object, j] : candidate.layout.operated) {
    const auto t = static_cast<std::size_t>(object);
    const ArticulatedObject& known = model.objects[t];
    const ObjectJoint& joint = known.joints[static_cast<std::size_t>(j)];
    std::vector<double> positions = state.joints[t];
    for (const double position : {joint.rest(), joint.joint_target()}) {
      positions[static_cast<std::size_t>(j)] = position;
      const auto link = static_cast<std::size_t>(joint.grasp_link);
      const Eigen::Vector3d grip =
          state.roots[t] * LinkPosesOf(known, positions)[link] * known.links[link].middle;
      if (!IsPointReachable(layout.world_from_robot, grip)) return "out-of-reach";
    }
  }
  return "";
}

// Returns true if an object that is put down or pushed to the goal of `step` would meet another.
bool IsGoalOccupied(const WorldModel& model, const WorldState& state, const Step& step) {
  const bool on_floor = step.goal && (step.action.kind == ActionKind::kPlace ||
                                      step.action.kind == ActionKind::kPush);
  if (!on_floor) return false;
  Eigen::AlignedBox3d box = WorldAabb(model, state, step.action.object);
  const Eigen::Vector3d shift = *step.goal - LinkPosition(model, state, step.action.object, 0);
  box.translate(Eigen::Vector3d(shift.x(), shift.y(), 0.0));
  for (int other = 0; other < static_cast<int>(model.objects.size()); ++other) {
    if (other == step.action.object) continue;
    const Eigen::AlignedBox3d there = WorldAabb(model, state, other);
    if (Eigen::AlignedBox2d(box.min().head<2>(), box.max().head<2>())
            .intersects(Eigen::AlignedBox2d(there.min().head<2>(), there.max().head<2>()))) {
      return true;
    }
  }
  return false;
}

// Returns the assets of a task: those of its candidate, then, in a given layout, all others that
// stand there.
std::vector<std::string> AssetsOf(const WorldModel& model, const TaskCandidate& candidate,
                                  const InitialState& start) {
  std::vector<std::string> names;
  for (const int object : candidate.layout.objects) {
    names.push_back(model.objects[static_cast<std::size_t>(object)].name);
  }
  for (const AssetPlacement& placement : start.placements) {
    if (std::find(names.begin(), names.end(), placement.asset) == names.end()) {
      names.push_back(placement.asset);
    }
  }
  return names;
}

Outcome BuildTask(const WorldModel& model, const TaskCandidate& candidate,
                  const RuleOptions& options, std::uint64_t index) {
  core::Rng rng = core::StreamRng(options.seed, index);
  std::optional<InitialState> start = options.layout;
  if (start) {
    const std::string obstacle = LayoutObstacle(model, *start, candidate);
    if (!obstacle.empty()) return {std::nullopt, obstacle};
  } else {
    start = PlanLayout(model, candidate.layout, rng);
  }
  if (!start) return {std::nullopt, "no-layout"};
  WorldState state = StateOf(model, *start);
  PredicateSet predicates = InitialPredicates(model, candidate, state);
  const std::vector<Operator> plan =
      Plan(OperatorsFor(model, candidate.layout.objects), candidate.goals, &predicates);
  if (plan.empty()) return {std::nullopt, "no-plan"};
  Task task;
  task.source = "rules";
  task.assets = AssetsOf(model, candidate, *start);
  SubtaskVerifier verifier(model);
  InitialState now = *start;
  std::set<std::string> names;  // repeated steps are numbered
  for (const Operator& one : plan) {
    const Step step = MakeStep(model, state, one, start->world_from_robot);
    if (options.layout && IsGoalOccupied(model, state, step)) {
      return {std::nullopt, "goal-occupied"};
    }
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
          BuildTask(model, candidates[index], options, index + 1);
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
