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
      "rollout", "Measure the success rate of a trained or shipped policy, with its 95 % interval");
  command->footer(
      "Examples:\n"
      "  simwright rollout pick --episodes 200 --pictures pick.png\n"
      "  simwright rollout open --on others.json --task 'open_microwave_*_door'\n"
      "  simwright rollout --skill open_drawer --on tasks.json --episodes 200\n"
      "The second evaluates a skill on microwaves that it was not trained on, the third a shipped\n"
      "policy (`simwright skills`) on the drawers of your own assets. Without --on, a shipped "
      "policy\n"
      "acts on new instances of the kind that it was trained on.");
  CLI::Option* folder =
      command->add_option("run", request->run, "The folder written by `simwright train`")
          ->default_str("none");
  CLI::Option* skill =
      command->add_option("--skill", request->skill, "A shipped policy, instead of a folder")
          ->excludes(folder);

  command->add_option("--episodes", request->episodes, "Number of episodes")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  CLI::Option* on = command->add_option("--on", request->on,
                                        "Run in the scenes of this tasks.json, on other assets");
  CLI::Option* task = command
                          ->add_option("--task", request->tasks,
                                       "With --on: a task in it, or a pattern of similar tasks; "
                                       "with --skill optional: all that fit")
                          ->needs(on);
  command
      ->add_option("--finger-friction", request->finger_friction,
                   "Friction of the fingers in every episode; default: sampled as in training")
      ->check(CLI::Range(0.05, 10.0));
  command->add_option("--pictures", request->pictures,
                      "Write pictures of one successful episode, PNG");
  command->add_option("--poses", request->poses,
                      "Write the poses of that episode at 60 Hz, JSON lines");
  AddCommon(command, common);
  command->callback([=] {
    if (folder->count() + skill->count() == 0) {
      throw CLI::RequiredError("a folder written by `simwright train`, or --skill NAME");
    }
    if (skill->count() == 0 && on->count() > 0 && task->count() == 0) {
      throw CLI::RequiresError("--on", "--task");
    }
    *run = [=] { return Rollout(*request, *common); };
  });
}

}  // namespace simwright::cli
