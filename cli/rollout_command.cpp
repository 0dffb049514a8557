#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "pipeline/skill_rollout.h"

namespace simwright::cli {
namespace {

int Rollout(const pipeline::RolloutRequest& given, const CommonOptions& common) {
  pipeline::RolloutRequest request = given;
  request.seed = common.seed;
  core::Progress progress(common.ProgressStyle());
  const pipeline::RolloutReport report = pipeline::Rollout(request, &progress);
  progress.Finish();
  if (common.json) {
    PrintJson(pipeline::RolloutJson(report), {});
  } else {
    std::fputs(pipeline::RolloutTable(report).c_str(), stdout);
  }
  return 0;
}

}  // namespace

void AddRollout(CLI::App* app, CommonOptions* common, Run* run) {
  auto request = std::make_shared<pipeline::RolloutRequest>();
  CLI::App* command =
      app->add_subcommand("rollout", "How often a trained task succeeds, with its 95 % interval");
  command->footer(
      "Examples:\n"
      "  simwright rollout pick --episodes 200 --pictures pick.png\n"
      "  simwright rollout open --on others.json --task 'open_microwave_*_door'\n"
      "The second shows what was learnt on some microwaves on others that it has not seen.");
  command->add_option("run", request->run, "The folder of `simwright train`")->required();
  command->add_option("--episodes", request->episodes, "Episodes to run")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  CLI::Option* on = command->add_option(
      "--on", request->on, "Roll out in the scenes of this tasks.json, on assets not trained on");
  on->needs(command
                ->add_option("--task", request->tasks,
                             "With --on: the task, or a pattern of tasks alike, in it")
                ->needs(on));
  command
      ->add_option("--finger-friction", request->finger_friction,
                   "Friction of the fingers in every episode; default: drawn as in training")
      ->check(CLI::Range(0.05, 10.0));
  command->add_option("--pictures", request->pictures,
                      "A strip of pictures of one episode that succeeds, PNG");
  command->add_option("--poses", request->poses,
                      "The same episode as poses at 60 Hz, lines of JSON");
  AddCommon(command, common);
  command->callback([request, common, run] { *run = [=] { return Rollout(*request, *common); }; });
}

}  // namespace simwright::cli
