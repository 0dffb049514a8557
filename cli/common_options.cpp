#include "cli/command.h"

#include <cstdio>

#include "cli/number_validators.h"
#include "cli/usage.h"
#include "core/device_choice.h"
#include "core/log.h"

namespace simwright::cli {

int ReportStopped(const std::filesystem::path& folder) {
  if (!core::ThisRank().leads()) return kInterrupted;
  std::fprintf(stderr,
               "error: stopped; finished work is kept in %s, the same command with --resume "
               "continues\n",
               folder.c_str());
  return kInterrupted;
}

void AddCommon(CLI::App* command, CommonOptions* common) {
  command->add_option("--seed", common->seed, "Seed of every random choice")
      ->capture_default_str()
      ->check(WholeNumber());
  command->add_option("--threads", common->threads, "Number of threads; 0: all")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--quiet", common->quiet, "Print only errors and results");
  AddChoice(command, "--log-level", {"trace", "debug", "info", "warn", "error", "off"}, "off",
            "Print the steps of the work to stderr, from this level on; without the option, the "
            "environment variable SIMWRIGHT_LOG sets the level",
            [](const std::string& name) { core::SetLogLevel(core::LogLevelNamed(name)); });
  command->add_flag("--json", common->json, "Print the result and its findings as JSON");
  command
      ->add_option("--config", common->config,
                   "Read flags from a TOML file, one section per subcommand; the command line "
                   "takes precedence")
      ->default_str("none")
      ->configurable(false);
}

void AddDevice(CLI::App* command) {
  AddChoice(command, "--device", {"auto", "cpu", "cuda"}, "auto",
            "Processor of networks; auto: a GPU if there is one", [](const std::string& name) {
              core::ChooseDevice(name == "cpu"    ? core::DeviceChoice::kCpu
                                 : name == "cuda" ? core::DeviceChoice::kCuda
                                                  : core::DeviceChoice::kAuto);
            });
}

void AddForce(CLI::App* command, CommonOptions* common) {
  command->add_flag("--force", common->force, "Replace an existing output");
}

}  // namespace simwright::cli
