#include "workflows/tasks/task_making.h"

#include <algorithm>
#include <cstdio>

#include "core/error.h"
#include "core/files.h"
#include "core/finding_json.h"
#include "core/finding_text.h"
#include "core/json.h"
#include "tasks/language/task_generation.h"
#include "tasks/rules/rule_tasks.h"
#include "tasks/task_file.h"
#include "tasks/verification/subtask_verifier.h"
#include "tasks/world_state.h"
#include "workflows/tasks/task_assets.h"
#include "workflows/tasks/task_page.h"

namespace simwright::workflows {
namespace {

namespace fs = std::filesystem;

void MakeByRules(const TasksRequest& request, const tasks::WorldModel& scene,
                 core::Progress* progress, TasksReport* report) {
  tasks::RuleOptions options;
  options.count = request.count;
  options.seed = request.seed;
  options.layout = request.layout;
  tasks::RuleTasks made = tasks::GenerateTasksByRules(scene, options, progress);
  report->set.tasks = std::move(made.tasks);
  report->dropped = std::move(made.dropped);
  report->findings.insert(report->findings.end(), made.findings.begin(), made.findings.end());
}

void MakeByModel(const TasksRequest& request, const TaskAssets& assets,
                 const tasks::WorldModel& scene, core::Progress* progress, TasksReport* report) {
  std::vector<tasks::NamedModel> named;
  for (const assets::SemanticModel& model : assets.models) named.push_back({model.name, &model});
  tasks::TaskGenerationOptions options;
  if (request.count > 0) options.count = request.count;
  options.seed = request.seed;
  tasks::VerificationOptions verification;
  verification.seed = request.seed;
  tasks::SubtaskVerifier verifier(scene, verification);
  tasks::GeneratedTasks made = tasks::GenerateTasksByModel(
      named, options, request.model,
      [&](const tasks::Task& task, tasks::Subtask* subtask) {
        return verifier.Verify(task, subtask);
      },
      progress);
  report->set.tasks = std::move(made.tasks);
  report->repaired = made.repaired;
  report->findings.insert(report->findings.end(), made.findings.begin(), made.findings.end());
}

int Findings(const tasks::Task& task) {
  std::size_t count = task.findings.size();
  for (const tasks::Subtask& subtask : task.subtasks) count += subtask.findings.size();
  return static_cast<int>(count);
}

int Repairs(const tasks::Task& task) {
  std::size_t count = 0;
  for (const tasks::Subtask& subtask : task.subtasks) count += subtask.attempts.size();
  return static_cast<int>(count);
}

}  // namespace

bool TasksReport::passed() const {
  return !set.tasks.empty() && std::all_of(set.tasks.begin(), set.tasks.end(),
                                           [](const tasks::Task& task) { return task.valid(); });
}

TasksReport MakeTasks(const TasksRequest& request, core::Progress* progress) {
  TasksReport report;
  report.file = request.output;
  report.page = fs::path(request.output).replace_extension(".html");
  for (const fs::path& file : {report.file, report.page}) {
    if (fs::exists(file) && !request.force) {
      throw core::Error("already exists", file.string(), "give another name, or --force");
    }
  }
  if (progress != nullptr) progress->Stage("assets");
  const TaskAssets assets = ReadTaskAssets(request.assets);
  report.findings = assets.findings;
  report.set.assets = assets.listed;
  const tasks::WorldModel scene = tasks::MakeWorldModel(assets.models);
  if (request.model == nullptr) {
    MakeByRules(request, scene, progress, &report);
  } else {
    MakeByModel(request, assets, scene, progress, &report);
  }
  const fs::path folder = fs::absolute(report.file).parent_path();
  fs::create_directories(folder);
  tasks::WriteTaskFile(report.set, report.file);
  core::WriteFile(report.page, TaskPage(report.set, scene));
  return report;
}

std::string TasksTable(const TasksReport& report) {
  std::size_t widest = 4;
  for (const tasks::Task& task : report.set.tasks) widest = std::max(widest, task.name.size());
  const auto row = [&](const std::string& name, const std::string& rest) {
    return name + std::string(widest + 2 - std::min(widest, name.size()), ' ') + rest + "\n";
  };
  std::string table = row("task", "subtasks  findings  repairs");
  for (const tasks::Task& task : report.set.tasks) {
    char figures[64];
    std::snprintf(figures, sizeof figures, "%8zu  %8d  %7d", task.subtasks.size(), Findings(task),
                  Repairs(task));
    table += row(task.name, figures + std::string(task.valid() ? "" : "  not valid"));
    for (const tasks::Subtask& subtask : task.subtasks) {
      for (const core::Finding& finding : subtask.findings) {
        core::Finding placed = finding;
        placed.place = subtask.name + (finding.place.empty() ? "" : ":" + finding.place);
        table += "    " + core::FindingText(placed, 0);
      }
    }
  }
  return table;
}

std::string TasksJson(const TasksReport& report) {
  core::OrderedJson json;
  json["file"] = report.file.string();
  json["page"] = report.page.string();
  json["passed"] = report.passed();
  json["repaired"] = report.repaired;
  json["tasks"] = core::OrderedJson::array();
  for (const tasks::Task& task : report.set.tasks) {
    json["tasks"].push_back({{"name", task.name},
                             {"subtasks", task.subtasks.size()},
                             {"sound", task.valid()},
                             {"findings", Findings(task)},
                             {"repairs", Repairs(task)}});
  }
  json["dropped"] = report.dropped;
  json["findings"] = core::FindingsJson(report.findings);
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

}  // namespace simwright::workflows
