#include <cstdio>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "workflows/priors/models_folder.h"
#include "workflows/skills/shipped_skills.h"

namespace simwright::cli {
namespace {

int ListShippedSkills(const CommonOptions& common) {
  const auto skills = workflows::ReadShippedSkills(workflows::ModelsFolder());
  if (common.json) {
    PrintJson(workflows::ShippedSkillsJson(skills), {});
  } else {
    std::fputs(workflows::ShippedSkillsTable(skills).c_str(), stdout);
  }
  return 0;
}

}  // namespace

void AddSkills(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* command = app->add_subcommand("skills", "List the shipped policies");
  command->footer(
      "Example:\n  simwright skills\n"
      "Each line states what a policy does, the robot, the kind of the library that it was "
      "trained\n"
      "on, its action space, the sizes of its observation and action, and the success rate on its\n"
      "card. `simwright rollout --skill NAME` runs one. See docs/skills.md.");
  AddCommon(command, common);
  command->callback([common, run] { *run = [=] { return ListShippedSkills(*common); }; });
}

}  // namespace simwright::cli
