#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/training_options.h"
#include "cli/twin_options.h"
#include "core/error.h"
#include "core/ranks.h"
#include "rl/communicator.h"
#include "transfer/twin_ranges.h"
#include "workflows/skills/skill_training.h"

namespace simwright::cli {
namespace {

struct SkillTrainFlags {
  workflows::TrainRequest request;
  std::filesystem::path twin;
  double sigmas = 2.0;
};

int TrainSkill(const SkillTrainFlags& flags, const CommonOptions& common) {
  workflows::TrainRequest request = flags.request;
  if (!flags.twin.empty()) {
    request.placement_ranges = transfer::PlacementRanges(flags.twin, flags.sigmas);
  }
  request.seed = common.seed;
  request.ranks = rl::JoinRanks(core::ThisRank());
  if (!request.ranks->leads()) {
    workflows::FollowTraining(request);
    request.ranks->Finalize();
    return 0;
  }
  core::Progress progress(common.ProgressStyle());
  workflows::TrainReport report;
  try {
    report = workflows::TrainTask(request, &progress);
  } catch (const core::Cancelled&) {
    progress.Finish();
    if (!std::filesystem::exists(request.output)) throw;  // it was stopped before it started
    return ReportStopped(request.output);
  }
  progress.Finish();
  request.ranks->Finalize();
  if (common.json) {
    PrintJson(workflows::TrainJson(report), report.findings);
    return 0;
  }
  PrintFindings(report.findings, common);
  if (!common.quiet) std::fputs(workflows::TrainTable(report).c_str(), stdout);
  std::printf("%.0f %% success: %s\n", 100.0 * report.success(), report.folder.c_str());
  return 0;
}

// Adds what acts, and how: the robot, its action space and its grasps.
void AddActionOptions(CLI::App* command, SkillTrainFlags* flags) {
  command
      ->add_option("--robot", flags->request.robot,
                   "panda, panda_on_base, or a URDF with a side file (docs/robots.md)")
      ->capture_default_str();
  command
      ->add_option_function<std::string>(
          "--action",
          [flags](const std::string& name) { flags->request.action = skills::ActionSpaceOf(name); },
          "Action space: the tool's pose in the interaction target's frame (focus), as a "
          "correction\n"
          "of a scripted expert (guided), in the robot's frame (absolute), as a step of the tool\n"
          "(delta) or of the joints (joints)")
      ->check(CLI::IsMember({"focus", "guided", "absolute", "delta", "joints"}))
      ->default_str("focus");
  command
      ->add_option_function<std::string>(
          "--grasps",
          [flags](const std::string& name) { flags->request.proved_grasps = name == "proved"; },
          "How objects and sliding parts are grasped: by the proved grasps of their grasps.json, "
          "where there\n"
          "is one (proved; see `simwright grasps`), or from above (above)")
      ->check(CLI::IsMember({"proved", "above"}))
      ->default_str("proved");
  command
      ->add_option("--seconds", flags->request.episode_seconds, "Maximum duration of an episode, s")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
}

}  // namespace

void AddTrain(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<SkillTrainFlags>();
  workflows::TrainRequest* request = &flags->request;
  CLI::App* command =
      app->add_subcommand("train", "Train a policy for each subtask of a task, in Bullet");
  command->footer(
      "Examples:\n  simwright train tasks.json --task pick_up_cup_1 -o pick\n"
      "  simwright train tasks.json --task 'pick_up_cup_*' -o pick_any\n"
      "  simwright train tasks.json --task pick_up_mug_1 --twin twin -o pick_mug\n"
      "Subtasks are learnt in order, each mostly from the ends of the previous one. Ctrl-C or a "
      "crash\n"
      "loses at most half a minute: --resume continues. mpirun's ranks train together\n"
      "(docs/scale.md). See docs/skills.md.");
  command->add_option("tasks", request->task_file, "The file written by `simwright tasks`")
      ->required();
  command
      ->add_option("--task", request->tasks,
                   "The task, '*' matches any characters; several tasks share one policy")
      ->required();
  command->add_option("-o,--output", request->output, "The run folder")->required();
  AddActionOptions(command, flags.get());
  CLI::Option* twin =
      command
          ->add_option("--twin", flags->twin,
                       "The folder of the twin that the tasks are from: its uncertainty is the "
                       "range in which objects are placed (docs/twin.md)")
          ->default_str("none: up to 15 cm away, at any yaw");
  AddSigmas(command, &flags->sigmas)->needs(twin);
  AddNoRandomization(command, &request->randomized);
  AddTrainingOptions(command, &request->environments, &request->samples, &request->minutes,
                     &request->target, &request->episodes, &request->imitated_samples);
  command
      ->add_option(
          "--backward-steps", request->backward_samples,
          "Decisions of backward tuning: a subtask after whose ends the next one loses success is\n"
          "trained further to end better; 0: none")
      ->check(CLI::Range(0, 2000000000))
      ->capture_default_str();
  command->add_flag("--resume", request->resume, "Resume an interrupted run");
  AddCommon(command, common);
  AddDevice(command);
  command->callback([flags, common, run] { *run = [=] { return TrainSkill(*flags, *common); }; });
}

}  // namespace simwright::cli
