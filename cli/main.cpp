#include <malloc.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "cli/build_information.h"
#include "cli/command.h"
#include "cli/findings_output.h"
#include "cli/usage.h"
#include "core/compute_environment.h"
#include "core/error.h"
#include "core/finding_text.h"
#include "core/parallel.h"
#include "core/ranks.h"

namespace {

int Main(int argc, char** argv) {
  using namespace simwright;
  CLI::App app{"Turns photos and meshes into simulation-ready assets, scenes, tasks and skills."};
  app.name("simwright");
  cli::PrepareApp(&app);
  app.footer(
      "Example:\n  simwright lift examples/apple.jpg --category apple -o apple\n"
      "Each subcommand has its own --help with an example.");
  app.require_subcommand(1);
  const std::string version = cli::VersionText();  // CLI11 adds the last line break
  app.set_version_flag("--version", version.substr(0, version.size() - 1),
                       "Print the version and what the program was built with");
  app.set_config("--config", "",
                 "Read flags from a TOML file, one section per subcommand; "
                 "the command line takes precedence");
  cli::CommonOptions common;
  cli::Run run;
  cli::AddLift(&app, &common, &run);
  cli::AddMat(&app, &common, &run);
  cli::AddImport(&app, &common, &run);
  cli::AddPhysics(&app, &common, &run);
  cli::AddCheck(&app, &common, &run);
  cli::AddGrasps(&app, &common, &run);
  cli::AddTexture(&app, &common, &run);
  cli::AddLibrary(&app, &common, &run);
  cli::AddPropose(&app, &common, &run);
  cli::AddPrior(&app, &common, &run);
  cli::AddFactory(&app, &common, &run);
  cli::AddTwin(&app, &common, &run);
  cli::AddTasks(&app, &common, &run);
  cli::AddReward(&app, &common, &run);
  cli::AddTrain(&app, &common, &run);
  cli::AddSkills(&app, &common, &run);
  cli::AddRollout(&app, &common, &run);
  cli::AddExport(&app, &common, &run);
  cli::AddReplay(&app, &common, &run);
  cli::AddScene(&app, &common, &run);
  cli::AddRun(&app, &common, &run);
  cli::AddView(&app, &common, &run);
  cli::AddDoctor(&app, &common, &run);
  cli::AddCompletion(&app, &common, &run);
  cli::AddVersion(&app, &common, &run);
  const std::vector<std::string> arguments = cli::ArgumentsOf(argc, argv);
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ParseError& error) {
    return cli::ReportUsage(app, arguments, error);
  }
  core::InstallCancelHandler();
  core::SetThreadCount(common.threads);
  try {
    return run();
  } catch (const core::Error& error) {
    cli::PrintError(core::FindingOf(error), common.json);
  } catch (const core::Cancelled&) {
    throw;
  } catch (const std::bad_alloc&) {
    cli::PrintError({"error", core::Severity::kError, "", "out of memory", 0.0,
                     "close other programs, or use a smaller input"},
                    common.json);
  } catch (const std::exception& error) {
    cli::PrintError({"error", core::Severity::kError, "", error.what()}, common.json);
  }
  return 1;
}

// Restarts the program with the environment that networks need. The restart takes a second, so only
// subcommands that run networks do it.
void StartWithThreadsAndKernels(int argc, char** argv) {
  const std::string_view command = argc > 1 ? argv[1] : "";
  if (command == "lift" || command == "prior" || command == "train" || command == "run" ||
      command == "scene" || command == "twin" || command == "factory") {
    simwright::core::RestartWithComputeEnvironment(argv);
  }
}

// Keeps freed memory in the process. Networks allocate and free tensors of megabytes all the time;
// returning them to the system costs a sixth of a training's time for clearing new pages.
void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 28);
  mallopt(M_TRIM_THRESHOLD, 1 << 29);
}

}  // namespace

int main(int argc, char** argv) {
  StartWithThreadsAndKernels(argc, argv);
  KeepFreedMemory();
  try {
    return Main(argc, argv);
  } catch (const simwright::core::Cancelled&) {
    if (simwright::core::ThisRank().leads()) {
      std::fprintf(stderr, "error: stopped; nothing was written\n");
    }
    return simwright::cli::kInterrupted;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "error: out of memory (close other programs, or use a smaller input)\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  }
  return 1;
}
