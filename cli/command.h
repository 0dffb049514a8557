#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "core/progress.h"
#include "core/ranks.h"

namespace simwright::cli {

constexpr int kInterrupted = 130;  // the exit code that shells report for Ctrl-C

// The flags that all subcommands share.
struct CommonOptions {
  std::uint64_t seed = 1;
  int threads = 0;
  bool quiet = false;
  bool json = false;
  bool force = false;
  std::string config;  // unused: ArgumentsOf passes --config to the program itself

  core::Progress::Style ProgressStyle() const {
    const bool silent = quiet || json || !core::ThisRank().leads();
    return silent ? core::Progress::Style::kSilent : core::Progress::StyleForStderr();
  }
};

// The function of the chosen subcommand. Each subcommand adds itself to `app` and sets `run` when
// it is chosen; `run` is called after parsing and returns the exit code (0; 1 for a failed check).
// Errors are thrown.
using Run = std::function<int()>;

// Prints that a run was stopped, that `folder` keeps its progress and that --resume continues it,
// of several ranks only the first; returns kInterrupted.
int ReportStopped(const std::filesystem::path& folder);

void AddCommon(CLI::App* command, CommonOptions* common);
// Adds --device, for subcommands that run networks.
void AddDevice(CLI::App* command);
void AddForce(CLI::App* command, CommonOptions* common);
void AddLift(CLI::App* app, CommonOptions* common, Run* run);
void AddMat(CLI::App* app, CommonOptions* common, Run* run);
void AddImport(CLI::App* app, CommonOptions* common, Run* run);
void AddPhysics(CLI::App* app, CommonOptions* common, Run* run);
void AddGrasps(CLI::App* app, CommonOptions* common, Run* run);
void AddTexture(CLI::App* app, CommonOptions* common, Run* run);
void AddCheck(CLI::App* app, CommonOptions* common, Run* run);
void AddLibrary(CLI::App* app, CommonOptions* common, Run* run);
void AddPropose(CLI::App* app, CommonOptions* common, Run* run);
void AddPrior(CLI::App* app, CommonOptions* common, Run* run);
void AddFactory(CLI::App* app, CommonOptions* common, Run* run);
void AddTwin(CLI::App* app, CommonOptions* common, Run* run);
void AddTasks(CLI::App* app, CommonOptions* common, Run* run);
void AddReward(CLI::App* app, CommonOptions* common, Run* run);
void AddTrain(CLI::App* app, CommonOptions* common, Run* run);
void AddSkills(CLI::App* app, CommonOptions* common, Run* run);
void AddRollout(CLI::App* app, CommonOptions* common, Run* run);
void AddExport(CLI::App* app, CommonOptions* common, Run* run);
void AddReplay(CLI::App* app, CommonOptions* common, Run* run);
void AddScene(CLI::App* app, CommonOptions* common, Run* run);
void AddRun(CLI::App* app, CommonOptions* common, Run* run);
void AddView(CLI::App* app, CommonOptions* common, Run* run);
void AddDoctor(CLI::App* app, CommonOptions* common, Run* run);
void AddCompletion(CLI::App* app, CommonOptions* common, Run* run);
void AddVersion(CLI::App* app, CommonOptions* common, Run* run);

}  // namespace simwright::cli
