#include "workflows/photo_run/photo_run.h"

#include <fnmatch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "core/image.h"
#include "core/json.h"
#include "tasks/task_file.h"
#include "validation/check.h"
#include "workflows/lift/lift.h"
#include "workflows/photo_run/photo_run_folder.h"
#include "workflows/photo_run/photo_run_page.h"
#include "workflows/photo_run/photo_run_record.h"
#include "workflows/photo_run/photo_run_report.h"
#include "workflows/photo_run/photo_run_scene.h"
#include "workflows/skills/skill_export.h"
#include "workflows/skills/skill_replay.h"
#include "workflows/skills/skill_rollout.h"
#include "workflows/skills/skill_training.h"
#include "workflows/tasks/task_making.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr int kPhotoRunTasks = 20;  // enough for every kind of task with an asset and furniture

using Clock = std::chrono::steady_clock;

double RunSeconds(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Names the asset after the category's canonical name, which is always a valid name in programs.
PhotoRunFolder FolderOf(const PhotoRunRequest& request) {
  const physics_params::Resolution category = physics_params::RequireCategory(request.category);
  return {request.output, assets::FileSafeName(category.category->name)};
}

// Rejects bad input before anything is written.
void RequireReadable(const PhotoRunRequest& request) {
  core::ReadImage(request.photo);
  if (request.mask) core::ReadImage(*request.mask);
}

void Lift(const PhotoRunRequest& request, const PhotoRunFolder& folder, core::Progress* progress) {
  LiftRequest lift;
  lift.photo = request.photo;
  lift.category = request.category;
  lift.mask = request.mask;
  lift.height = request.height;
  lift.effort = request.effort;
  lift.seed = request.seed;
  lift.output = folder.Asset();
  lift.force = true;  // an interrupted run may have left an unrecorded one
  LiftToFolder(lift, progress);
}

void Check(const PhotoRunFolder& folder, core::Progress* progress) {
  progress->Stage("check");
  const validation::CheckReport report = validation::CheckAsset(folder.Asset());
  core::WriteFile(folder.Check(), validation::CheckJson(report));
  if (report.passed()) {
    assets::AddFindings(folder.Asset(), report.Warnings());
    return;
  }
  throw core::Error(validation::CheckFailed(report, "the reconstructed asset").what(),
                    folder.Asset().string(),
                    "`simwright check` says why; look at its preview.png: a --mask or another "
                    "photo may help");
}

void Furnish(const PhotoRunRequest& request, const PhotoRunFolder& folder,
             core::Progress* progress) {
  if (request.task.empty()) RequireLiftable(folder.Asset());
  const Furniture made =
      MakeFurniture(folder.Asset(), request.furniture, request.seed, folder.Furniture(), progress);
  const core::OrderedJson scene = {
      {"furniture", made.name}, {"kind", made.kind}, {"holds_it", made.holds}};
  core::WriteFile(folder.Scene(), core::JsonText(scene));
}

// Returns the requested task from the generated ones.
tasks::Task ChosenTask(const PhotoRunRequest& request, const PhotoRunFolder& folder) {
  const std::string pattern = request.task.empty() ? "pick_up_" + folder.asset_name : request.task;
  std::vector<tasks::Task> matching;
  std::string all, matches;
  for (const tasks::Task& task : tasks::ReadTaskFile(folder.Tasks()).tasks) {
    all += (all.empty() ? "" : ", ") + task.name;
    if (fnmatch(pattern.c_str(), task.name.c_str(), 0) != 0) continue;
    matches += (matches.empty() ? "" : ", ") + task.name;
    matching.push_back(task);
  }
  if (matching.empty()) {
    throw core::Error("there is no task '" + pattern + "'", folder.Tasks().string(),
                      "known ones are " + all);
  }
  if (matching.size() > 1) {
    throw core::Error("'" + pattern + "' matches several tasks", folder.Tasks().string(),
                      "choose one of " + matches);
  }
  return matching.front();
}

void MakeTaskFile(const PhotoRunRequest& request, const PhotoRunFolder& folder,
                  core::Progress* progress) {
  const core::JsonDocument scene =
      core::JsonDocument::Read(folder.Scene(), 1 << 16, "--force starts over");
  TasksRequest tasks;
  tasks.assets = {folder.Asset().string(),
                  (folder.Furniture() / scene.root()["furniture"].Text()).string()};
  tasks.output = folder.Tasks();
  tasks.count = kPhotoRunTasks;
  tasks.seed = request.seed;
  tasks.force = true;  // an interrupted run may have left one
  MakeTasks(tasks, progress);
  ChosenTask(request, folder);
}

// Trains the task and returns the seconds that its subtasks took over all runs.
double Train(const PhotoRunRequest& request, const PhotoRunFolder& folder,
             core::Progress* progress) {
  TrainRequest train;
  train.task_file = folder.Tasks();
  train.tasks = {ChosenTask(request, folder).name};
  train.output = folder.Skill();
  train.environments = request.environments;
  train.samples = request.samples;
  train.minutes = request.minutes;
  train.target = request.target;
  train.episodes = request.episodes;
  train.imitated_samples = request.imitated_samples;
  train.seed = request.seed;
  train.resume = true;  // if there is an earlier state
  double seconds = 0.0;
  for (const TrainedSkill& skill : TrainTask(train, progress).skills) seconds += skill.seconds;
  return seconds;
}

void Evaluate(const PhotoRunRequest& request, const PhotoRunFolder& folder,
              core::Progress* progress) {
  RolloutRequest rollout;
  rollout.run = folder.Skill();
  rollout.episodes = request.episodes;
  rollout.seed = request.seed;
  rollout.pictures = folder.Strip();
  rollout.poses = folder.Poses();
  const RolloutReport report = Rollout(rollout, progress);
  core::WriteFile(folder.Rollout(), RolloutJson(report));
}

// Exports the first successful episode of the evaluation, which the pictures show, and its replay.
void ExportFirst(const PhotoRunRequest& request, const PhotoRunFolder& folder,
                 core::Progress* progress) {
  ExportRequest wanted;
  wanted.run = folder.Skill();
  wanted.output = folder.Trajectory();
  wanted.seed = request.seed;
  const ExportReport report = Export(wanted, progress);
  core::WriteFile(folder.Export(), ExportJson(report));
  progress->Stage("replay");
  const ReplayReport replay = Replay({{folder.Trajectory()}, folder.Skill()}, progress);
  core::WriteFile(folder.Replay(), ReplayJson(replay));
}

// Returns an error's message without its location, because pages and reports are passed on.
std::string WithoutPlace(const core::Error& error) {
  const std::string what = error.what(), place = error.where() + ": ";
  return what.starts_with(place) ? what.substr(place.size()) : what;
}

PhotoRunOutcome OutcomeOf(const PhotoRunFolder& folder, const core::JsonField& report) {
  PhotoRunOutcome outcome;
  outcome.task = report["task"]["name"].Text();
  const core::JsonField success = report["success"];
  outcome.episodes = success["episodes"].Int();
  outcome.successes = success["successes"].Int();
  outcome.interval = {success["low"].Number(), success["high"].Number()};
  outcome.replayed = report["trajectory"].FlagOr("replayed", false);
  outcome.seconds = report["seconds"].Number();
  outcome.folder = folder.root;
  outcome.page = folder.Page();
  outcome.picture = folder.Strip();
  outcome.trajectory = folder.Trajectory();
  outcome.findings = PhotoRunFindings(folder);
  return outcome;
}

// Runs the stages that are not done and records their times.
class StageRunner {
 public:
  explicit StageRunner(PhotoRunRecord* record) : record_(record) {}

  // `work` returns the seconds recorded in its own files, which include those of interrupted runs.
  void Run(const std::string& name, const std::function<double()>& work) {
    if (record_->Done(name)) return;
    const Clock::time_point start = Clock::now();
    double told = 0.0;
    try {
      told = work();
    } catch (...) {
      Note(name, RunSeconds(start));
      throw;
    }
    const double spent = RunSeconds(start);
    record_->Spend(name, std::max(spent, told - record_->SecondsOf(name)), true);
  }

 private:
  // A full disk must not hide the original error.
  void Note(const std::string& name, double seconds) {
    try {
      record_->Spend(name, seconds, false);
    } catch (const core::Error&) {
    }
  }

  PhotoRunRecord* record_;
};

void RunStages(const PhotoRunRequest& request, const PhotoRunFolder& folder, PhotoRunRecord* record,
               core::Progress* progress) {
  StageRunner runner(record);
  const auto run = [&](const std::string& name, const std::function<void()>& work) {
    runner.Run(name, [&] {
      work();
      return 0.0;
    });
  };
  run("lift", [&] { Lift(request, folder, progress); });
  run("check", [&] { Check(folder, progress); });
  run("scene", [&] { Furnish(request, folder, progress); });
  run("tasks", [&] { MakeTaskFile(request, folder, progress); });
  try {
    runner.Run("train", [&] { return Train(request, folder, progress); });
    run("evaluate", [&] { Evaluate(request, folder, progress); });
  } catch (const core::Error& error) {
    throw core::Error(std::string(error.what()) + "; finished stages are kept, --resume continues");
  }
}

}  // namespace

PhotoRunOutcome RunPhoto(const PhotoRunRequest& request, core::Progress* progress) {
  const PhotoRunFolder folder = FolderOf(request);
  RequireReadable(request);
  PhotoRunRecord record(request);
  try {
    RunStages(request, folder, &record, progress);
  } catch (...) {
    record.RemoveIfNothingIsDone();
    throw;
  }
  std::string refusal;
  try {
    StageRunner(&record).Run("export", [&] {
      ExportFirst(request, folder, progress);
      return 0.0;
    });
  } catch (const core::Error& error) {
    refusal = WithoutPlace(error);
  }
  progress->Stage("page");
  const tasks::Task task = ChosenTask(request, folder);
  const std::string text =
      core::JsonText(PhotoRunReport(request, folder, task, record.stages(), refusal));
  const core::JsonDocument report(text, folder.Report().string(), "--force starts over");
  const std::string page = PhotoRunPage(folder, task, report.root());
  core::WriteFile(folder.Report(), text);
  core::WriteFile(folder.Page(), page);
  progress->Finish();
  if (refusal.empty()) {
    PhotoRunOutcome outcome = OutcomeOf(folder, report.root());
    outcome.json = text;
    return outcome;
  }
  throw core::Error("there is no trajectory: " + refusal + "; " + folder.Page().string() +
                    " shows its progress");
}

std::string PhotoRunTable(const PhotoRunOutcome& outcome) {
  char line[160];
  std::snprintf(
      line, sizeof(line), "success: %d of %d, %.1f %% (95 %%: %.1f to %.1f), in %.1f minutes\n",
      outcome.successes, outcome.episodes,
      100.0 * outcome.successes / std::max(1, outcome.episodes), 100.0 * outcome.interval.low,
      100.0 * outcome.interval.high, outcome.seconds / 60.0);
  return outcome.task + "\n" + line + "trajectory: " + outcome.trajectory.string() +
         (outcome.replayed ? ", succeeds when replayed from its file alone\n"
                           : ", FAILS when replayed from its file alone\n") +
         "picture:    " + outcome.picture.string() + "\npage:       " + outcome.page.string() +
         "\n";
}

}  // namespace simwright::workflows
