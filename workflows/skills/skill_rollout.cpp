#include "workflows/skills/skill_rollout.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "core/json.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "skills/skill_evaluation.h"
#include "tasks/task_file.h"
#include "workflows/skills/rollout_pictures.h"
#include "workflows/skills/skill_recording.h"

namespace simwright::workflows {
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

RolloutReport Rollout(const RolloutRequest& request, core::Progress* progress) {
  std::optional<tasks::TaskSet> on;
  if (!request.on.empty()) {
    on = ChooseTasks(tasks::ReadTaskFile(request.on), request.tasks, request.on.string());
  }
  const TrainedTask task(request.run, on, request.finger_friction);
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

std::string RolloutTable(const RolloutReport& report) {
  std::string table;
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
  return core::JsonText(text);
}

}  // namespace simwright::workflows
