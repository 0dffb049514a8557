#include "cli/command.h"

namespace simwright::cli {

void AddCommon(CLI::App* command, CommonOptions* common) {
  command->add_option("--seed", common->seed, "Seed of every random choice")->capture_default_str();
  command->add_option("--threads", common->threads, "Threads to use; 0: all of the machine's")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--quiet", common->quiet, "Say nothing but errors and results");
  command->add_flag("--json", common->json, "Print the result as JSON");
}

void AddForce(CLI::App* command, CommonOptions* common) {
  command->add_flag("--force", common->force, "Replace an output that exists");
}

}  // namespace simwright::cli
