#include "cli/command.h"

#include <cstdio>

namespace simwright::cli {

int StoppedWith(const std::filesystem::path& folder) {
  std::fprintf(stderr,
               "error: stopped; what was done is kept in %s, the same command with --resume goes "
               "on\n",
               folder.c_str());
  return kInterrupted;
}

void AddCommon(CLI::App* command, CommonOptions* common) {
  command->add_option("--seed", common->seed, "Seed of every random choice")->capture_default_str();
  command->add_option("--threads", common->threads, "Threads to use; 0: all of the machine's")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--quiet", common->quiet, "Say nothing but errors and results");
  command->add_flag("--json", common->json, "Print the result and its findings as JSON");
  command
      ->add_option("--config", common->config,
                   "Read flags from a TOML file, a section a subcommand; flags given here win")
      ->default_str("none")
      ->configurable(false);
}

void AddForce(CLI::App* command, CommonOptions* common) {
  command->add_flag("--force", common->force, "Replace an output that exists");
}

}  // namespace simwright::cli
