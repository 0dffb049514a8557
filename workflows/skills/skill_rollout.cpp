#include "workflows/skills/skill_rollout.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "core/json.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "skills/skill_evaluation.h"
#include "tasks/task_file.h"
#include "workflows/priors/models_folder.h"
#include "workflows/skills/rollout_pictures.h"
#include "workflows/skills/shipped_skills.h"
#include "workflows/skills/skill_recording.h"
#include "workflows/skills/skill_suite.h"
#include "workflows/skills/skill_training.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

void Show(const TrainedTask& task, const RolloutRequest& request,
          const skills::ChainEvaluation& chain) {
  const auto good =
      std::find_if(chain.outcomes.begin(), chain.outcomes.end(),
                   [](const skills::ChainOutcome& outcome) { return outcome.success; });
  const auto episode =
      static_cast<std::uint64_t>(good == chain.outcomes.end() ? 0 : good - chain.outcomes.begin());
  const ChainRecording recording = RecordEpisode(task.links(), request.seed, episode);
  if (!request.poses.empty()) {
    core::WriteFile(request.poses, RolloutPoses(task.run(), task.skills(), recording));
  }
  if (!request.pictures.empty()) {
    core::WritePng(request.pictures, RolloutStrip(task.skills(), recording));
  }
}

SkillRun ReadWithFriction(const std::filesystem::path& folder, std::optional<double> friction) {
  SkillRun run = ReadRun(folder);
  if (friction) run.options.finger_friction = skills::FactorRange{*friction, *friction};
  return run;
}

RolloutReport RollOut(const TrainedTask& task, const RolloutRequest& request,
                      core::Progress* progress) {
  RolloutReport report;
  for (const RunSkill& skill : task.skills()) report.subtasks.push_back(skill.name);
  progress->Stage("roll out");
  report.chain = skills::EvaluateChain(task.links(), request.episodes, request.seed);
  for (const skills::ChainOutcome& outcome : report.chain.outcomes) {
    if (!outcome.success) continue;
    for (const skills::EvaluatedEpisode& link : outcome.links) report.seconds += link.seconds;
  }
  if (report.chain.successes > 0) report.seconds /= report.chain.successes;
  if (!request.pictures.empty() || !request.poses.empty()) {
    progress->Stage("draw");
    Show(task, request, report.chain);
  }
  return report;
}

// Returns the cell's evaluation tasks, made below `folder`. The kind "photo" has one instance.
tasks::TaskSet EvaluationTasks(const SuiteCell& cell, const fs::path& models,
                               const fs::path& folder, core::Progress* progress) {
  const fs::path photo = models.parent_path() / "examples" / "coffee.png";
  if (cell.kind == "photo" && !fs::exists(photo)) {
    throw core::Error("the photo of the skill '" + cell.name + "' is missing", photo.string(),
                      "give tasks of your own with --on");
  }
  return tasks::ReadTaskFile(
      MakeCellTasks(cell, kUnseenSeed, kUnseenInstances, photo, folder, progress));
}

RolloutReport RollOutShippedSkill(const RolloutRequest& request, core::Progress* progress) {
  const fs::path models = ModelsFolder();
  const ShippedSkill shipped = ReadShippedSkill(models, request.skill);
  rl::Policy policy = rl::ReadPolicy(shipped.file);
  const core::TemporaryFolder folder;
  const bool own = request.on.empty();
  progress->Stage("choose the tasks");
  SkillMatch match =
      own ? MatchSkill(shipped.cell, policy,
                       EvaluationTasks(shipped.cell, models, folder.path(), progress), {"*"},
                       "the evaluation instances")
          : MatchSkill(shipped.cell, policy, tasks::ReadTaskFile(request.on), request.tasks,
                       request.on.string());
  SkillRun run;
  run.folder = folder.path();
  run.robot = shipped.cell.robot;
  run.options.action = shipped.action;
  run.proved_grasps = false;  // shipped policies learnt to grasp from above
  run.options.finger_friction = TrainRequest().finger_friction;
  if (request.finger_friction) {
    run.options.finger_friction =
        skills::FactorRange{*request.finger_friction, *request.finger_friction};
  }
  run.set = std::move(match.set);
  RolloutReport report = RollOut(TrainedTask(std::move(run), std::move(policy)), request, progress);
  report.skill = request.skill;
  report.subtasks = {request.skill};
  report.taken = std::move(match.taken);
  report.skipped = std::move(match.skipped);
  return report;
}

// Returns the lines that say where a shipped policy acted, with tasks of one reason together.
std::string MatchTable(const RolloutReport& report) {
  std::string table = "skill " + report.skill + " in " + std::to_string(report.taken.size()) +
                      (report.taken.size() == 1 ? " step:\n" : " steps:\n");
  for (const TakenSubtask& taken : report.taken) {
    table += "  " + taken.subtask;
    table += taken.task == taken.subtask ? "\n" : " of " + taken.task + "\n";
  }
  std::map<std::string, std::vector<std::string>> reasons;
  for (const SkippedTask& skipped : report.skipped) reasons[skipped.reason].push_back(skipped.task);
  for (const auto& [reason, names] : reasons) {
    table += names.size() == 1
                 ? "skipped " + names.front()
                 : "skipped " + std::to_string(names.size()) + " tasks (" + names.front() + " ...)";
    table += ": " + reason + "\n";
  }
  return table;
}

}  // namespace

TrainedTask::TrainedTask(const std::filesystem::path& folder,
                         const std::optional<tasks::TaskSet>& on,
                         std::optional<double> finger_friction)
    : run_(ReadWithFriction(folder, finger_friction)),
      skills_(PrepareSkillsOn(on.value_or(run_.set), run_)) {
  if (on) run_.set = *on;
  policies_.reserve(skills_.size());
  for (const RunSkill& skill : skills_) {
    const std::filesystem::path file = skill.folder / rl::kPolicyFile;
    if (!std::filesystem::exists(file)) {
      throw core::Error("the subtask '" + skill.name + "' has no policy yet", file.string(),
                        "continue with `simwright train ... --resume`");
    }
    policies_.push_back(rl::ReadPolicy(file));
    skills::RequireFits(policies_.back(), *skill.evaluated);
    links_.push_back({skill.evaluated.get(), &policies_.back()});
  }
}

TrainedTask::TrainedTask(SkillRun run, rl::Policy policy)
    : run_(std::move(run)), skills_(PrepareSkills(run_)) {
  policies_.push_back(std::move(policy));
  const skills::Skill& skill = *skills_.front().evaluated;
  skills::RequireFits(policies_.front(), skill);
  links_.push_back({&skill, &policies_.front()});
}

RolloutReport Rollout(const RolloutRequest& request, core::Progress* progress) {
  if (!request.skill.empty()) return RollOutShippedSkill(request, progress);
  std::optional<tasks::TaskSet> on;
  if (!request.on.empty()) {
    on = ChooseTasks(tasks::ReadTaskFile(request.on), request.tasks, request.on.string());
  }
  return RollOut(TrainedTask(request.run, on, request.finger_friction), request, progress);
}

std::string RolloutTable(const RolloutReport& report) {
  std::string table = report.skill.empty() ? "" : MatchTable(report);
  char line[192];
  if (report.subtasks.size() > 1) {
    for (size_t k = 0; k < report.subtasks.size(); ++k) {
      std::snprintf(line, sizeof(line), "%-40.40s %4d of %4d\n", report.subtasks[k].c_str(),
                    report.chain.succeeded[k], report.chain.tried[k]);
      table += line;
    }
  }
  const auto episodes = report.chain.outcomes.size();
  std::snprintf(
      line, sizeof(line), "success: %d of %zu, %.1f %% (95 %%: %.1f to %.1f), %.1f s on average\n",
      report.chain.successes, episodes,
      100.0 * report.chain.successes / static_cast<double>(episodes),
      100.0 * report.chain.interval.low, 100.0 * report.chain.interval.high, report.seconds);
  return table + line;
}

std::string RolloutJson(const RolloutReport& report) {
  core::Json text = {{"episodes", report.chain.outcomes.size()},
                     {"successes", report.chain.successes},
                     {"low", report.chain.interval.low},
                     {"high", report.chain.interval.high},
                     {"mean_seconds", report.seconds}};
  for (size_t k = 0; k < report.subtasks.size(); ++k) {
    text["subtasks"].push_back({{"name", report.subtasks[k]},
                                {"tried", report.chain.tried[k]},
                                {"succeeded", report.chain.succeeded[k]}});
  }
  if (!report.skill.empty()) {
    text["skill"] = report.skill;
    text["taken"] = text["skipped"] = core::Json::array();
    for (const TakenSubtask& taken : report.taken) {
      text["taken"].push_back({{"task", taken.task}, {"subtask", taken.subtask}});
    }
    for (const SkippedTask& skipped : report.skipped) {
      text["skipped"].push_back({{"task", skipped.task}, {"reason", skipped.reason}});
    }
  }
  return core::JsonText(text);
}

}  // namespace simwright::workflows
