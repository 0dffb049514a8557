#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "workflows/tasks/reward_check.h"

namespace simwright::cli {
namespace {

struct RewardFlags {
  workflows::RewardCheckRequest request;
  bool no_scene = false;
};

int Reward(const RewardFlags& flags, const CommonOptions& common) {
  workflows::RewardCheckRequest request = flags.request;
  request.scene = !flags.no_scene;
  const workflows::RewardCheckReport report = workflows::CheckReward(request);
  if (common.json) {
    PrintJson(workflows::RewardCheckJson(report), report.findings);
  } else if (!common.quiet || !report.passed()) {
    std::fputs(workflows::RewardCheckText(report).c_str(), stdout);
  }
  return report.passed() ? 0 : 1;
}

}  // namespace

void AddReward(CLI::App* app, CommonOptions* common, Run* run) {
  auto flags = std::make_shared<RewardFlags>();
  CLI::App* command = app->add_subcommand("reward", "Check a reward program before training");
  command->footer(
      "Examples:\n  simwright reward open_door.py --assets microwave\n"
      "  simwright reward locomotion.py --no-scene\n"
      "The exit code is 1 if the program has an error. See docs/rewards.md for the language.");
  command->add_option("program", flags->request.program, "A file with the reward function")
      ->required();
  CLI::Option* assets = command->add_option(
      "--assets", flags->request.assets,
      "Asset folders or URDFs that the program may name, each as PATH or NAME=PATH");
  command
      ->add_flag("--no-scene", flags->no_scene,
                 "Check the function alone: its parameters are inputs, names are not looked up")
      ->excludes(assets);
  command->add_option("--function", flags->request.entry, "The reward function")
      ->default_str("found by its name");
  AddCommon(command, common);
  command->callback([flags, common, run] { *run = [=] { return Reward(*flags, *common); }; });
}

}  // namespace simwright::cli
