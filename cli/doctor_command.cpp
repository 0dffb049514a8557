#include <cstdio>

#include "cli/command.h"
#include "core/parallel.h"
#include "pipeline/doctor.h"

namespace simwright::cli {

void AddDoctor(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* command = app->add_subcommand("doctor", "What was found, what is slow, how to mend it");
  command->footer("Example:\n  simwright doctor");
  AddCommon(command, common);
  command->callback([run] {
    *run = [] {
      bool sound = true;
      for (const core::Finding& finding : pipeline::Examine()) {
        const bool bad = finding.severity == core::Severity::kError;
        sound = sound && !bad;
        std::printf("%-4s  %-12s %s\n",
                    bad                                            ? "FAIL"
                    : finding.severity == core::Severity::kWarning ? "warn"
                                                                   : "good",
                    finding.code.c_str(), finding.sentence.c_str());
      }
      return sound ? 0 : 1;
    };
  });
}

void AddVersion(CLI::App* app, Run* run) {
  CLI::App* command = app->add_subcommand("version", "The program's version");
  command->footer("Example:\n  simwright version");
  command->callback([run] {
    *run = [] {
      std::printf("simwright %s\n", SIMWRIGHT_VERSION);
      return 0;
    };
  });
}

}  // namespace simwright::cli
