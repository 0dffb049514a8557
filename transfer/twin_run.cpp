#include "transfer/twin_run.h"

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/json.h"
#include "tasks/task_file.h"
#include "transfer/pick_choice.h"
#include "transfer/twin_ranges.h"
#include "transfer/twin_tasks.h"
#include "workflows/skills/skill_rollout.h"

namespace simwright::transfer {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRecord = "twin_run.json";
constexpr const char* kTaskFindings = "task_findings.json";
constexpr const char* kSkill = "skill";

std::string RecordText(const TwinRunRequest& request) {
  core::Json json = {{"format", 1},
                     {"twin", fs::weakly_canonical(request.twin).string()},
                     {"task", request.task},
                     {"sigmas", request.sigmas},
                     {"randomized", request.train.randomized},
                     {"seed", request.seed}};
  if (request.robot) json["robot"] = {request.robot->x(), request.robot->y(), request.robot->z()};
  return core::JsonText(json);
}

// Begins or continues the run in its folder.
void OpenRun(const TwinRunRequest& request) {
  const fs::path record = request.output / kRecord;
  const bool exists = fs::exists(request.output), is_run = fs::exists(record);
  if (exists && request.force && !is_run) {
    throw core::Error("is no run on a twin, and stays", request.output.string(),
                      "give another folder");
  }
  if (exists && request.force) fs::remove_all(request.output);
  if (exists && !request.force && !(request.resume && is_run)) {
    throw core::Error("already exists", request.output.string(),
                      "continue with --resume, or give another folder, or --force");
  }
  const std::string text = RecordText(request);
  if (exists && !request.force && core::ReadFile(record) != text) {
    throw core::Error("the folder has a run with another twin or other options",
                      request.output.string(), "give the options of the first call, or --force");
  }
  fs::create_directories(request.output);
  core::WriteFile(record, text);
}

// Returns the name of the task to train: the one that matches, by default of picking up the object
// that leaves the fingers most room.
std::string ChosenTask(const TwinRunRequest& request, const tasks::TaskSet& set,
                       const workflows::TwinRecord& record, const fs::path& file) {
  if (set.tasks.empty()) {
    throw core::Error("the robot can do no task with the twin's objects", request.twin.string(),
                      "simwright tasks --twin lists why; --base X,Y,DEGREES moves the robot");
  }
  if (!request.task.empty()) {
    return workflows::ChooseTasks(set, {request.task}, file.string()).tasks.front().name;
  }
  const std::vector<std::string> picks = SurestPicks(set, record);
  if (!picks.empty()) return picks.front();
  throw core::Error("no object of the twin can be picked up", request.twin.string(),
                    "choose another --task of " + file.string());
}

// Makes the tasks with their findings, or reads those of an earlier call. Tasks without stored
// findings are made again, unless a policy is trained on them.
tasks::TaskSet TasksOf(const TwinRunRequest& request, const fs::path& file,
                       core::Progress* progress, core::Findings* findings) {
  const fs::path stored = request.output / kTaskFindings;
  if (fs::exists(file) && !fs::exists(stored) && fs::exists(request.output / kSkill)) {
    return tasks::ReadTaskFile(file);
  }
  if (fs::exists(file) && fs::exists(stored)) {
    const core::JsonDocument document(core::ReadFile(stored), stored.string(), "");
    *findings = core::FindingsFrom(document.root());
    return tasks::ReadTaskFile(file);
  }
  TwinTasksRequest wanted;
  wanted.twin = request.twin;
  wanted.output = file;
  wanted.robot = request.robot;
  wanted.seed = request.seed;
  wanted.force = true;  // a stopped run may have left them without findings
  workflows::TasksReport report = MakeTwinTasks(wanted, progress);
  core::WriteFile(stored, core::JsonText(core::StoredFindingsJson(report.findings)));
  *findings = std::move(report.findings);
  return std::move(report.set);
}

workflows::TrainReport Train(const TwinRunRequest& request, const fs::path& tasks,
                             const std::string& task, core::Progress* progress) {
  workflows::TrainRequest train = request.train;
  train.task_file = tasks;
  train.tasks = {task};
  train.output = request.output / kSkill;
  train.placement_ranges = PlacementRanges(request.twin, request.sigmas);
  train.seed = request.seed;
  train.resume = true;  // if there is an earlier state
  return workflows::TrainTask(train, progress);
}

// Appends the findings that are not known yet: training and check report on the same assets.
void AddFindings(const core::Findings& more, core::Findings* findings) {
  for (const core::Finding& finding : more) {
    const bool known = std::any_of(findings->begin(), findings->end(), [&](const auto& other) {
      return other.code == finding.code && other.place == finding.place &&
             other.sentence == finding.sentence;
    });
    if (!known) findings->push_back(finding);
  }
}

}  // namespace

TwinRunOutcome RunTwin(const TwinRunRequest& request, core::Progress* progress) {
  const workflows::TwinRecord record = workflows::ReadTwin(request.twin);
  OpenRun(request);
  TwinRunOutcome outcome;
  outcome.folder = request.output;
  const fs::path tasks = request.output / "tasks.json", skill = request.output / kSkill;
  const tasks::TaskSet set = TasksOf(request, tasks, progress, &outcome.findings);
  outcome.task = ChosenTask(request, set, record, tasks);
  const workflows::TrainReport trained = Train(request, tasks, outcome.task, progress);
  outcome.success = trained.success();
  AddFindings(trained.findings, &outcome.findings);
  workflows::RolloutRequest rollout;
  rollout.run = skill;
  rollout.episodes = 1;
  rollout.seed = request.seed;
  rollout.pictures = outcome.picture = request.output / "rollout.png";
  workflows::Rollout(rollout, progress);
  MotionChoiceRequest choice;
  choice.run = skill;
  choice.twin = request.twin;
  choice.output = request.output / "trajectory.yaml";
  choice.sigmas = request.sigmas;
  choice.seed = request.seed;
  outcome.motion = ExportChosenMotion(choice, progress);
  TransferRequest check;
  check.motion = choice.output;
  check.twin = request.twin;
  check.run = skill;
  check.worlds = request.worlds;
  check.seed = request.seed + 1;  // other worlds than those by which the motion was chosen
  outcome.transfer = CheckTransfer(check, progress);
  AddFindings(outcome.transfer.findings, &outcome.findings);
  core::WriteFile(request.output / "report.json", TwinRunJson(outcome));
  progress->Finish();
  return outcome;
}

std::string TwinRunTable(const TwinRunOutcome& outcome) {
  char line[96];
  std::snprintf(line, sizeof line, "trained: %.0f %% success within the ranges of the training\n",
                100.0 * outcome.success);
  return line + MotionChoiceTable(outcome.motion) + TransferTable(outcome.transfer) +
         "picture: " + outcome.picture.string() + "\n";
}

std::string TwinRunJson(const TwinRunOutcome& outcome) {
  core::OrderedJson json;
  json["task"] = outcome.task;
  json["success"] = outcome.success;
  json["motion"] = core::ParseOrderedJson(MotionChoiceJson(outcome.motion), "motion");
  json["transfer"] = core::ParseOrderedJson(TransferJson(outcome.transfer), "transfer");
  json["folder"] = outcome.folder.string();
  json["picture"] = outcome.picture.string();
  json["findings"] = core::FindingsJson(outcome.findings);
  return core::JsonText(json);
}

}  // namespace simwright::transfer
