#include <cstdio>
#include <memory>
#include <vector>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/language_model_options.h"
#include "cli/twin_options.h"
#include "transfer/twin_tasks.h"
#include "workflows/tasks/task_making.h"

namespace simwright::cli {
namespace {

struct TasksFlags {
  workflows::TasksRequest request;
  LanguageModelOptions language;
  std::filesystem::path twin;
  RobotBaseFlag robot;
};

workflows::TasksReport MakeTwinTasks(const TasksFlags& flags, const CommonOptions& common,
                                     core::Progress* progress) {
  transfer::TwinTasksRequest request;
  request.twin = flags.twin;
  request.output = flags.request.output;
  request.count = flags.request.count;
  request.robot = flags.robot.base();
  request.seed = common.seed;
  request.force = common.force;
  return transfer::MakeTwinTasks(request, progress);
}

int Tasks(const TasksFlags& flags, const CommonOptions& common) {
  workflows::TasksRequest request = flags.request;
  request.seed = common.seed;
  request.force = common.force;
  std::unique_ptr<llm::ChatModel> model;
  if (flags.language.given()) model = MakeLanguageModel(flags.language, common);
  request.model = model.get();
  core::Progress progress(common.ProgressStyle());
  const workflows::TasksReport report = flags.twin.empty()
                                            ? workflows::MakeTasks(request, &progress)
                                            : MakeTwinTasks(flags, common, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(workflows::TasksJson(report), report.findings);
    return report.passed() ? 0 : 1;
  }
  if (!common.quiet) std::fputs(workflows::TasksTable(report).c_str(), stdout);
  PrintFindings(report.findings, common);
  if (model != nullptr && !common.quiet) std::printf("%s\n", UsageLine(model->usage()).c_str());
  std::printf("%zu tasks: %s\npage: %s\n", report.set.tasks.size(), report.file.c_str(),
              report.page.c_str());
  return report.passed() ? 0 : 1;
}

}  // namespace

void AddTasks(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<TasksFlags>();
  CLI::App* command = app->add_subcommand(
      "tasks", "Generate tasks, subtasks and verified reward programs for assets");
  command->footer(
      "Examples:\n  simwright tasks microwave mug plate -o tasks.json\n"
      "  simwright tasks --twin twin -o tasks.json\n"
      "  simwright tasks kitchen --llm http://localhost:8080/v1 --count 12 -o tasks.json\n"
      "A folder of asset folders means all of them. All tasks are written, valid or not; the "
      "exit\n"
      "code is 1 if a task is not valid or there is none. See docs/tasks.md.");
  CLI::Option* assets =
      command
          ->add_option("assets", flags->request.assets,
                       "Asset folders, URDFs, or folders of them, each as PATH or NAME=PATH")
          ->default_str("none: --twin");
  CLI::Option* twin =
      command
          ->add_option("--twin", flags->twin,
                       "A folder of `simwright twin`, in place of assets: tasks about its objects, "
                       "which stand as they do there (docs/twin.md)")
          ->excludes(assets)
          ->default_str("none");
  AddRobotBase(command, &flags->robot)->needs(twin);
  command->add_option("-o,--output", flags->request.output, "The output file, tasks.json")
      ->required();
  command->add_option("--count", flags->request.count, "Number of tasks")
      ->check(CLI::Range(0, 100000))
      ->default_str("5 per asset by rules, 8 by a language model");
  AddLanguageModel(command, &flags->language);
  AddCommon(command, common);
  AddForce(command, common);
  command->callback([flags, common, run] {
    if (flags->request.assets.empty() && flags->twin.empty()) {
      throw CLI::RequiredError("assets, or --twin");
    }
    if (!flags->twin.empty() && flags->language.given()) {
      throw CLI::ValidationError("--twin", "makes its tasks by rules, without --llm");
    }
    *run = [=] { return Tasks(*flags, *common); };
  });
}

}  // namespace simwright::cli
