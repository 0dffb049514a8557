#include <cstdio>

#include "cli/build_information.h"
#include "cli/command.h"
#include "cli/findings_output.h"
#include "core/json.h"
#include "core/parallel.h"
#include "workflows/doctor.h"

namespace simwright::cli {

void AddDoctor(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* command = app->add_subcommand(
      "doctor", "Examine the installation: what is missing or slow, and how to fix it");
  command->footer("Example:\n  simwright doctor");
  AddCommon(command, common);
  command->callback([common, run] {
    *run = [common] {
      bool passed = true;
      const core::Findings findings = workflows::Examine();
      for (const core::Finding& finding : findings) {
        const bool bad = finding.severity == core::Severity::kError;
        passed = passed && !bad;
        if (common->json) continue;
        const std::string remedy = finding.remedy.empty() ? "" : " (" + finding.remedy + ")";
        std::printf("%-4s  %-12s %s%s\n",
                    bad                                            ? "FAIL"
                    : finding.severity == core::Severity::kWarning ? "warn"
                                                                   : "good",
                    finding.code.c_str(), finding.sentence.c_str(), remedy.c_str());
      }
      if (common->json) PrintJson(core::OrderedJson{{"passed", passed}}, findings);
      return passed ? 0 : 1;
    };
  });
}

void AddVersion(CLI::App* app, CommonOptions* common, Run* run) {
  CLI::App* command =
      app->add_subcommand("version", "Print the version and what the program was built with");
  command->footer("Example:\n  simwright version");
  AddCommon(command, common);
  command->callback([common, run] {
    *run = [common] {
      if (common->json) {
        core::OrderedJson built;
        for (const auto& [name, version] : BuiltWith()) built[name] = version;
        PrintJson(
            core::OrderedJson{
                {"program", "simwright"}, {"version", SIMWRIGHT_VERSION}, {"built_with", built}},
            {});
        return 0;
      }
      std::fputs(VersionText().c_str(), stdout);
      return 0;
    };
  });
}

}  // namespace simwright::cli
