#include <cstdio>
#include <map>
#include <memory>

#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/shell_completion.h"
#include "cli/usage.h"
#include "core/json.h"

namespace simwright::cli {

void AddCompletion(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* command = app->add_subcommand(
      "completion", "Print a script that completes commands in bash, zsh or fish");
  command->footer(
      "Example:\n"
      "  simwright completion --shell bash > ~/.local/share/bash-completion/completions/simwright\n"
      "  simwright completion --shell zsh > \"${fpath[1]}/_simwright\"\n"
      "  simwright completion --shell fish > ~/.config/fish/completions/simwright.fish\n"
      "The Debian package installs all three.");
  const auto shell = std::make_shared<Shell>(Shell::kBash);
  AddChoice(command, "--shell", {"bash", "zsh", "fish"}, "bash", "The shell",
            [shell](const std::string& name) {
              const std::map<std::string, Shell> shells = {
                  {"bash", Shell::kBash}, {"zsh", Shell::kZsh}, {"fish", Shell::kFish}};
              *shell = shells.at(name);
            });
  AddCommon(command, common);
  command->callback([app, common, run, shell] {
    *run = [app, common, shell] {
      const std::string script = ShellCompletion(*app, *shell);
      if (common->json) {
        PrintJson(core::OrderedJson{{"script", script}}, {});
      } else {
        std::fputs(script.c_str(), stdout);
      }
      return 0;
    };
  });
}

}  // namespace simwright::cli
