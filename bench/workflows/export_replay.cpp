// Measures how many exported motions reproduce their task: the shipped policy of each cell of the
// suite (workflows/skills/skill_suite.h) is exported on unseen instances, and the files are
// replayed.
//   bench_export_replay                      100 motions per skill
//   bench_export_replay --cell lift_lid --episodes 20
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_export.h"
#include "workflows/skills/skill_replay.h"
#include "workflows/skills/skill_run.h"
#include "workflows/skills/skill_suite.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

struct Arguments {
  std::string cell = "all";
  int episodes = 100;
  int threads = 0;
  std::uint64_t seed = 1;
  fs::path output = "out/export_replay";
  fs::path models = fs::path(SIMWRIGHT_SOURCE_DIR) / "models";
};

// Returns a run folder as if the shipped policy had been trained in it.
fs::path MakeRun(const workflows::SuiteCell& cell, const Arguments& arguments,
                 core::Progress* progress) {
  const bool photo = cell.kind == "photo";  // its one object is also the training object
  const fs::path folder = arguments.output / cell.name;
  const rl::Policy policy = rl::ReadPolicy(workflows::ShippedPolicy(arguments.models, cell.name));
  workflows::SkillRun run;
  run.robot = cell.robot;
  run.options.action = workflows::ActionSpaceOf(policy);
  run.folder = folder / "run";
  run.set = tasks::ReadTaskFile(MakeCellTasks(
      cell, photo ? workflows::kSeenSeed : workflows::kUnseenSeed, workflows::kUnseenInstances,
      fs::path(SIMWRIGHT_SOURCE_DIR) / "examples" / "coffee.png", folder, progress));
  workflows::WriteRun(run);
  const fs::path skill = workflows::PrepareSkills(run).front().folder;
  fs::create_directories(skill);
  rl::WritePolicy(policy, skill / rl::kPolicyFile);
  return run.folder;
}

void Measure(const workflows::SuiteCell& cell, const Arguments& arguments,
             core::Progress* progress) {
  workflows::ExportRequest request;
  request.run = MakeRun(cell, arguments, progress);
  request.output = arguments.output / cell.name / "motions";
  request.episodes = arguments.episodes;
  request.seed = arguments.seed;
  request.force = true;
  const workflows::ExportReport exported = workflows::Export(request, progress);
  const workflows::ReplayReport replayed = workflows::Replay({{request.output}, {}}, progress);
  progress->Finish();
  std::printf("| %-21s | %3d of %3d | %3d | %3d | %3d | %3d of %3zu | %.1f s | %.2f |\n",
              cell.name.c_str(), exported.succeeded, exported.tried,
              exported.episodes - exported.closer, exported.closer,
              exported.succeeded - exported.episodes, replayed.successes, replayed.episodes.size(),
              exported.seconds, exported.stretch);
  std::fflush(stdout);
}

void Run(const Arguments& arguments) {
  core::Progress progress(core::Progress::StyleForStderr());
  std::printf(
      "| skill                 | rollouts   | at once | closer | left out | replayed | mean | "
      "stretch |\n|---|---|---|---|---|---|---|---|\n");
  for (const workflows::SuiteCell& cell : workflows::SkillSuite()) {
    if (arguments.cell == "all" || arguments.cell == cell.name) {
      Measure(cell, arguments, &progress);
    }
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("How many exported motions reproduce their task");
  simwright::Arguments arguments;
  app.add_option("--cell", arguments.cell, "One cell, or all")->capture_default_str();
  app.add_option("--episodes", arguments.episodes, "Motions to export per cell, at least two")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "Seed of the episodes")->capture_default_str();
  app.add_option("--threads", arguments.threads, "Threads; 0: all")->capture_default_str();
  app.add_option("-o", arguments.output, "Output folder of assets and motions")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    if (arguments.cell != "all") simwright::workflows::CellOf(arguments.cell);
    simwright::core::SetThreadCount(arguments.threads);
    simwright::Run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
