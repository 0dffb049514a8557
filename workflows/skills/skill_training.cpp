#include "workflows/skills/skill_training.h"

#include <cstdio>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "core/folder_lock.h"
#include "core/json.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "skills/start_pool.h"
#include "tasks/task_file.h"
#include "workflows/grasps/asset_grasps.h"
#include "workflows/skills/backward_tuning.h"
#include "workflows/skills/rank_training.h"
#include "workflows/skills/subtask_training.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr const char* kEndsFile = "ends.jsonl";  // ends of successful episodes

core::Json IntervalJson(const skills::SkillEvaluation& evaluation) {
  return {{"episodes", evaluation.episodes.size()},
          {"successes", evaluation.successes},
          {"rate", evaluation.rate()},
          {"low", evaluation.interval.low},
          {"high", evaluation.interval.high},
          {"mean_seconds", evaluation.seconds}};
}

std::string TrainingPercent(const skills::SkillEvaluation& evaluation) {
  if (evaluation.episodes.empty()) return "-";
  char text[64];
  std::snprintf(text, sizeof(text), "%.0f %% (%.0f-%.0f)", 100.0 * evaluation.rate(),
                100.0 * evaluation.interval.low, 100.0 * evaluation.interval.high);
  return text;
}

// Throws core::Error for an asset of the tasks that has no placement range, though others have one:
// it would silently stay in its place.
void RequirePlacementRanges(const std::map<std::string, skills::PlacementRange>& ranges,
                            const tasks::TaskSet& set) {
  if (ranges.empty()) return;
  for (const tasks::TaskAsset& asset : set.assets) {
    if (ranges.contains(asset.name)) continue;
    throw core::Error(
        "the twin has no object of that name, so the range of its placement is unknown",
        "asset '" + asset.name + "'", "give the twin that the tasks are from");
  }
}

SkillRun RunOf(const TrainRequest& request) {
  if (request.environments < request.ranks->size()) {
    throw core::Error("there are more ranks than environments", "--envs",
                      "give at least one environment a rank");
  }
  SkillRun run;
  run.folder = request.output;
  run.set = ChooseTasks(tasks::ReadTaskFile(request.task_file), request.tasks,
                        request.task_file.string());
  run.robot = request.robot;
  run.options.action = request.action;
  // Without a grasps.json the run is as those from before grasps were proved.
  run.proved_grasps = request.proved_grasps && AnyAssetHasGrasps(run.set);
  run.options.episode_seconds = request.episode_seconds;
  run.options.finger_friction = request.finger_friction;
  RequirePlacementRanges(request.placement_ranges, run.set);
  run.options.placement_ranges = request.placement_ranges;
  run.randomized = request.randomized;
  if (!run.randomized) {  // objects stay where they are, also where they are out of reach
    for (const tasks::TaskAsset& asset : run.set.assets) {
      run.options.placement_ranges.emplace(asset.name, skills::PlacementRange());
    }
  }
  run.environments = request.environments;
  run.seed = request.seed;
  return run;
}

// The training of a task's subtasks and its report.
class TaskTraining {
 public:
  TaskTraining(const TrainRequest& request, core::Progress* progress)
      : request_(request), progress_(progress), run_(RunOf(request)) {
    if (fs::exists(run_.folder) && !request.resume) {
      throw core::Error("already exists", run_.folder.string(),
                        "continue with --resume, or give another folder");
    }
    // An existing folder is locked before the slow steps; a new one is created only once all inputs
    // are valid.
    if (fs::exists(run_.folder)) lock_.emplace(run_.folder, "a training");
    skills_ = PrepareSkills(run_, &report_.findings);
    report_.grasps = GraspCounts(skills_);
    if (!lock_) lock_.emplace(run_.folder, "a training");
    WriteRun(run_);
    report_.folder = run_.folder;
  }

  TrainReport Train() {
    for (size_t k = 0; k < skills_.size(); ++k) Learn(k);
    DismissRanks(request_);
    if (request_.backward_samples > 0) {
      for (size_t k = skills_.size() - 1; k-- > 0;) Tune(k);
    }
    if (skills_.size() > 1) {
      progress_->Stage("evaluate the whole task");
      std::vector<skills::ChainLink> links;
      for (size_t k = 0; k < skills_.size(); ++k) {
        links.push_back({skills_[k].evaluated.get(), &policies_[k]});
      }
      report_.chain = skills::EvaluateChain(links, request_.episodes, request_.seed + 2000);
    }
    core::WriteFile(run_.folder / "report.json", TrainJson(report_));
    return report_;
  }

 private:
  // Returns the starts of subtask `k` in the chain; empty for the first.
  std::vector<skills::StartState> PoolOf(size_t k) const {
    return k == 0 ? std::vector<skills::StartState>() : ends_[k - 1];
  }
  // Returns the text after a subtask's name if there are several.
  std::string Place(size_t k) const {
    if (skills_.size() == 1) return "";
    return ", subtask " + std::to_string(k + 1) + " of " + std::to_string(skills_.size());
  }
  void Learn(size_t k);
  void Evaluate(size_t k);
  void Tune(size_t k);

  const TrainRequest& request_;
  core::Progress* progress_;
  SkillRun run_;
  std::optional<core::FolderLock> lock_;
  std::vector<RunSkill> skills_;
  std::vector<rl::Policy> policies_;
  std::vector<std::vector<skills::StartState>> ends_;  // of successes, by subtask
  TrainReport report_;
};

void TaskTraining::Learn(size_t k) {
  const RunSkill& skill = skills_[k];
  // A successor that has begun to learn started from the ends of this subtask's episodes.
  const bool next_begun =
      k + 1 < skills_.size() && fs::exists(skills_[k + 1].folder / rl::kCheckpointFile);
  const Trained numbers =
      TrainSubtask(request_, run_, skill, PoolOf(k), next_begun, Place(k), progress_);
  TrainedSkill& trained = report_.skills.emplace_back();
  trained.name = skill.name;
  trained.folder = skill.folder;
  trained.samples = numbers.samples;
  trained.seconds = numbers.seconds;
  trained.shares = numbers.shares;
  policies_.push_back(rl::ReadPolicy(skill.folder / rl::kPolicyFile));
  ends_.emplace_back();
  Evaluate(k);
  if (ends_[k].empty() && k + 1 < skills_.size()) {
    throw core::Error("was not learnt: the next subtasks have no starts", "subtask " + skill.name,
                      "give more --minutes or --steps, and --resume");
  }
}

// Evaluates subtask `k` from its own starts and from the ends of the previous one.
void TaskTraining::Evaluate(size_t k) {
  const skills::Skill& skill = *skills_[k].evaluated;
  TrainedSkill& trained = report_.skills[k];
  progress_->Stage("evaluate " + skills_[k].name + Place(k));
  trained.own = skills::Evaluate(
      skill, policies_[k], skills::SampleStarts(skill, request_.episodes, request_.seed + 1000));
  const std::vector<skills::StartState> pool = PoolOf(k);
  if (!pool.empty()) {
    trained.handover =
        skills::Evaluate(skill, policies_[k], ReplannedStarts(skill, pool, request_.seed));
  }
  ends_[k] = SuccessfulEnds(pool.empty() ? trained.own : trained.handover);
  skills::WriteStarts(ends_[k], skills_[k].folder / kEndsFile);
}

// Tunes subtask `k` to end better if the next one loses success by starting where it ends.
void TaskTraining::Tune(size_t k) {
  const TrainedSkill& next = report_.skills[k + 1];
  report_.skills[k].tuning = ReadBackwardTuning(skills_[k]);
  if (report_.skills[k].tuning || next.HandoverLoss() <= request_.largest_handover_loss) return;
  const TunedPair pair{&skills_[k], &skills_[k + 1], PoolOf(k), next.handover.episodes};
  report_.skills[k].tuning = TuneBackward(request_, run_, pair, progress_);
  if (!report_.skills[k].tuning->kept) return;
  policies_[k] = rl::ReadPolicy(skills_[k].folder / rl::kPolicyFile);
  for (size_t later = k; later < skills_.size(); ++later) Evaluate(later);
}

}  // namespace

std::string TrainedSkill::Method() const {
  const auto decisions = [](std::int64_t count) {
    char text[48];
    std::snprintf(text, sizeof(text), " (%.0fk decisions)", 1e-3 * static_cast<double>(count));
    return std::string(text);
  };
  const std::int64_t other = shares.imitated + shares.critic_alone;
  std::string method;
  if (shares.imitated > 0) method = "imitation of a scripted expert";
  if (shares.critic_alone > 0) method = "a scripted expert";
  if (method.empty()) return "PPO";
  return other >= samples ? method : method + decisions(other) + ", then PPO";
}

double TrainReport::success() const {
  if (chain.outcomes.empty()) return skills.empty() ? 0.0 : skills.front().own.rate();
  return static_cast<double>(chain.successes) / static_cast<double>(chain.outcomes.size());
}

TrainReport TrainTask(const TrainRequest& request, core::Progress* progress) {
  return TaskTraining(request, progress).Train();
}

void FollowTraining(const TrainRequest& request) {
  const SkillRun run = RunOf(request);
  FollowRankZero(request, run, PrepareSkills(run));
}

std::string TrainTable(const TrainReport& report) {
  std::string table =
      "subtask                            samples  minutes  own starts       handover\n";
  for (const TrainedSkill& skill : report.skills) {
    char line[256];
    std::snprintf(line, sizeof(line), "%-34.34s %8lld %8.1f  %-16s %s\n", skill.name.c_str(),
                  static_cast<long long>(skill.samples), skill.seconds / 60.0,
                  TrainingPercent(skill.own).c_str(), TrainingPercent(skill.handover).c_str());
    table += line + ("  learnt by " + skill.Method() + "\n");
    if (!skill.tuning) continue;
    std::snprintf(line, sizeof(line),
                  "  tuned for the next one: both succeed in %.0f %%, before in %.0f %%%s\n",
                  100.0 * skill.tuning->after, 100.0 * skill.tuning->before,
                  skill.tuning->kept ? "" : "; not kept");
    table += line;
  }
  for (const auto& [asset, count] : report.grasps) {
    table += asset + " may be grasped by " + std::to_string(count) + " proved grasps\n";
  }
  if (!report.chain.outcomes.empty()) {
    char line[128];
    std::snprintf(line, sizeof(line), "whole task: %d of %zu, %.0f %% (%.0f-%.0f)\n",
                  report.chain.successes, report.chain.outcomes.size(), 100.0 * report.success(),
                  100.0 * report.chain.interval.low, 100.0 * report.chain.interval.high);
    table += line;
  }
  return table;
}

std::string TrainJson(const TrainReport& report) {
  core::Json text;
  text["folder"] = report.folder.string();
  text["success"] = report.success();
  for (const auto& [asset, count] : report.grasps) text["proved_grasps"][asset] = count;
  for (const TrainedSkill& skill : report.skills) {
    core::Json one = {{"name", skill.name},
                      {"samples", skill.samples},
                      {"seconds", skill.seconds},
                      {"method", skill.Method()},
                      {"imitated", skill.shares.imitated},
                      {"own_starts", IntervalJson(skill.own)}};
    if (!skill.handover.episodes.empty()) {
      one["after_the_one_before"] = IntervalJson(skill.handover);
      one["handover_loss"] = skill.HandoverLoss();
    }
    if (skill.tuning) {
      one["tuned_backward"] = {{"samples", skill.tuning->samples},
                               {"seconds", skill.tuning->seconds},
                               {"before", skill.tuning->before},
                               {"after", skill.tuning->after},
                               {"kept", skill.tuning->kept}};
    }
    text["subtasks"].push_back(one);
  }
  if (!report.chain.outcomes.empty()) {
    text["chain"] = {{"episodes", report.chain.outcomes.size()},
                     {"successes", report.chain.successes},
                     {"low", report.chain.interval.low},
                     {"high", report.chain.interval.high},
                     {"tried", report.chain.tried},
                     {"succeeded", report.chain.succeeded}};
  }
  return core::JsonText(text);
}

}  // namespace simwright::workflows
