#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "workflows/skills/skill_rollout.h"

namespace simwright::cli {
namespace {

int Rollout(const workflows::RolloutRequest& given, const CommonOptions& common) {
  workflows::RolloutRequest request = given;
  request.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const workflows::RolloutReport report = workflows::Rollout(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(workflows::RolloutJson(report), {});
  } else {
    std::fputs(workflows::RolloutTable(report).c_str(), stdout);
  }
  return 0;
}

}  // namespace

void AddRollout(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<workflows::RolloutRequest>();
  CLI::App* command = app->add_subcommand(
      "rollout", "Measure the success rate of a trained task, with its 95 % interval");
  command->footer(
      "Examples:\n"
      "  simwright rollout pick --episodes 200 --pictures pick.png\n"
      "  simwright rollout open --on others.json --task 'open_microwave_*_door'\n"
      "The second evaluates a skill on microwaves that it was not trained on.");
  command->add_option("run", request->run, "The folder written by `simwright train`")->required();
  command->add_option("--episodes", request->episodes, "Number of episodes")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  CLI::Option* on = command->add_option("--on", request->on,
                                        "Run in the scenes of this tasks.json, on other assets");
  on->needs(command
                ->add_option("--task", request->tasks,
                             "With --on: a task in it, or a pattern of similar tasks")
                ->needs(on));
  command
      ->add_option("--finger-friction", request->finger_friction,
                   "Friction of the fingers in every episode; default: sampled as in training")
      ->check(CLI::Range(0.05, 10.0));
  command->add_option("--pictures", request->pictures,
                      "Write pictures of one successful episode, PNG");
  command->add_option("--poses", request->poses,
                      "Write the poses of that episode at 60 Hz, JSON lines");
  AddCommon(command, common);
  command->callback([request, common, run] { *run = [=] { return Rollout(*request, *common); }; });
}

}  // namespace simwright::cli
