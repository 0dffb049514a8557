// Measures training skill by skill: each cell of the suite (workflows/skills/skill_suite.h) is
// trained on instances of the library and evaluated, from full start states, on others.
//   bench_skill_suite                                the shipped policies, a minute
//   bench_skill_suite --script                       the scripted expert, 3 minutes
//   bench_skill_suite --cell NAME --train [--ship]   trains a cell (all: one after the other)
//   bench_skill_suite --on-seeds 301 9001            each cell on eight instances of either range
// An interrupted training resumes; a finished cell is kept: remove its folder to repeat it.
#include <algorithm>
#include <cstdio>
#include <optional>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "rl/wilson_interval.h"
#include "skills/skill_evaluation.h"
#include "tasks/task_file.h"
#include "workflows/skills/skill_rollout.h"
#include "workflows/skills/skill_suite.h"
#include "workflows/skills/skill_training.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

struct Arguments {
  std::string cell = "all";
  std::string action = skills::NameOf(workflows::TrainRequest().action);
  bool train = false, ship = false, script = false, by_task = false;
  double minutes = 0.0;  // 0: the cell's own
  int instances = 0;     // 0: the cell's own
  std::int64_t samples = 1'000'000'000;
  double target = workflows::TrainRequest().target;
  std::int64_t imitated = workflows::TrainRequest().imitated_samples;
  int episodes = 300;
  double finger_friction = 0.0;  // of the evaluation; 0: the robot's own
  // The first seeds of the ranges of evaluation instances, each evaluated apart, and their length.
  std::vector<std::uint64_t> first_seeds = {workflows::kUnseenSeed};
  int range = workflows::kUnseenInstances;
  std::uint64_t seed = 1;
  fs::path output = "out/skill_suite";
  fs::path models = fs::path(SIMWRIGHT_SOURCE_DIR) / "models";
};

struct CellResult {
  std::string name;
  double samples = 0.0, minutes = 0.0;
  skills::SkillEvaluation unseen;
};

fs::path Photo() {
  return fs::path(SIMWRIGHT_SOURCE_DIR) / "examples" / "coffee.png";
}

int InstancesOf(const workflows::SuiteCell& cell, const Arguments& arguments) {
  return arguments.instances > 0 ? arguments.instances : cell.instances;
}

// Returns the folder of the assets and tasks of a range of evaluation instances.
fs::path UnseenFolder(const Arguments& arguments, std::uint64_t first_seed) {
  if (first_seed == workflows::kUnseenSeed && arguments.range == workflows::kUnseenInstances) {
    return arguments.output / "unseen";
  }
  return arguments.output /
         ("unseen_" + std::to_string(first_seed) + "_" + std::to_string(arguments.range));
}

workflows::SkillRun UnseenRun(const workflows::SuiteCell& cell, skills::ActionSpace action,
                              const Arguments& arguments, std::uint64_t first_seed,
                              core::Progress* progress) {
  // The object reconstructed from the one photo is the only one to pick.
  const bool photo = cell.kind == "photo";
  workflows::SkillRun run;
  run.robot = cell.robot;
  run.options.action = action;
  if (arguments.finger_friction > 0.0) {
    run.options.finger_friction =
        skills::FactorRange{arguments.finger_friction, arguments.finger_friction};
  }
  run.folder =
      (photo ? arguments.output / "seen" : UnseenFolder(arguments, first_seed)) / cell.name;
  run.set = tasks::ReadTaskFile(MakeCellTasks(cell, photo ? workflows::kSeenSeed : first_seed,
                                              arguments.range, Photo(), run.folder, progress));
  return run;
}

void PrintByTask(const skills::Skill& skill, const skills::SkillEvaluation& evaluation) {
  std::vector<int> tried(skill.variants.size()), good(skill.variants.size());
  for (const skills::EvaluatedEpisode& episode : evaluation.episodes) {
    ++tried[static_cast<size_t>(episode.start.variant)];
    good[static_cast<size_t>(episode.start.variant)] += episode.success;
  }
  for (size_t v = 0; v < tried.size(); ++v) {
    std::printf("  %-40s %3d of %3d\n", skill.variants[v].subtask.name.c_str(), good[v], tried[v]);
  }
}

// Evaluates a policy file, or the scripted expert.
skills::SkillEvaluation EvaluateUnseen(const workflows::SuiteCell& cell,
                                       const std::optional<fs::path>& policy,
                                       const Arguments& arguments, std::uint64_t first_seed,
                                       core::Progress* progress) {
  std::optional<rl::Policy> known;
  if (policy) known = rl::ReadPolicy(*policy);
  const skills::ActionSpace action =
      known ? workflows::ActionSpaceOf(*known) : workflows::TrainRequest().action;
  const auto skills = PrepareSkills(UnseenRun(cell, action, arguments, first_seed, progress));
  const skills::Skill& skill = *skills.front().evaluated;
  progress->Stage("evaluate " + cell.name);
  const auto starts = skills::SampleStarts(skill, arguments.episodes, 7000 + arguments.seed);
  const skills::SkillEvaluation evaluation = known ? skills::Evaluate(skill, *known, starts)
                                                   : skills::EvaluateScriptedExpert(skill, starts);
  if (arguments.by_task) PrintByTask(skill, evaluation);
  return evaluation;
}

std::string Row(const CellResult& result) {
  char line[160];
  const skills::SkillEvaluation& unseen = result.unseen;
  std::snprintf(line, sizeof(line),
                "| %-26s | %5.0fk | %5.1f | %3d of %3zu | %5.1f %% (%.1f-%.1f) | %.1f s |\n",
                result.name.c_str(), 1e-3 * result.samples, result.minutes, unseen.successes,
                unseen.episodes.size(), 100.0 * unseen.rate(), 100.0 * unseen.interval.low,
                100.0 * unseen.interval.high, unseen.seconds);
  return line;
}

// Returns the flags that override the cell's own settings.
std::string Settings(const Arguments& arguments) {
  char minutes[48] = "", instances[48] = "";
  if (arguments.minutes > 0.0) {
    std::snprintf(minutes, sizeof(minutes), " --minutes %g", arguments.minutes);
  }
  if (arguments.instances > 0) {
    std::snprintf(instances, sizeof(instances), " --instances %d", arguments.instances);
  }
  char imitated[48] = "";
  if (arguments.imitated != workflows::TrainRequest().imitated_samples) {
    std::snprintf(imitated, sizeof(imitated), " --imitate %lld",
                  static_cast<long long>(arguments.imitated));
  }
  char samples[48] = "", target[32] = "";
  if (arguments.samples != Arguments().samples) {
    std::snprintf(samples, sizeof(samples), " --samples %lld",
                  static_cast<long long>(arguments.samples));
  }
  if (arguments.target != Arguments().target) {
    std::snprintf(target, sizeof(target), " --target %g", arguments.target);
  }
  const bool other = arguments.action != skills::NameOf(workflows::TrainRequest().action);
  return std::string(minutes) + samples + target + instances + imitated +
         (other ? " --action " + arguments.action : "");
}

// Returns the card that describes a shipped policy.
std::string Card(const workflows::SuiteCell& cell, const Arguments& arguments,
                 const CellResult& result) {
  std::string card = "# " + cell.name + "\n\n";
  card += "Policy of the skill suite: robot " + cell.robot + ", kind `" + cell.kind + "`, tasks `" +
          cell.pattern + "`, seed " + std::to_string(arguments.seed) +
          ". Trained and evaluated by\n\n";
  card += "    build/bin/bench_skill_suite --cell " + cell.name + " --train --ship --seed " +
          std::to_string(arguments.seed) + Settings(arguments) + "\n\n";
  card +=
      "| skill | samples | minutes | successes | rate (95 %) | mean time "
      "|\n|---|---|---|---|---|---|\n";
  card += Row(result);
  card +=
      cell.kind == "photo"
          ? "\nTrained and evaluated on the one reconstructed object, from other full start states"
          : "\nTrained on " + std::to_string(InstancesOf(cell, arguments)) +
                " instances, evaluated on " + std::to_string(workflows::kUnseenInstances) +
                " others, from full start states";
  card += " (docs/skills.md).\n\n![training](" + cell.name + ".svg)\n";
  return card;
}

CellResult Train(const workflows::SuiteCell& cell, const Arguments& arguments,
                 core::Progress* progress) {
  workflows::TrainRequest request;
  const fs::path seen = arguments.output / "seen" / cell.name;
  request.task_file = MakeCellTasks(cell, workflows::kSeenSeed, InstancesOf(cell, arguments),
                                    Photo(), seen, progress);
  request.tasks = {"*"};
  request.output = arguments.output / ("run_" + cell.name + "_" + std::to_string(arguments.seed));
  request.minutes = arguments.minutes > 0.0 ? arguments.minutes : cell.minutes;
  request.samples = arguments.samples;
  request.target = arguments.target;
  request.seed = arguments.seed;
  request.imitated_samples = arguments.imitated;
  request.action = skills::ActionSpaceOf(arguments.action);
  request.robot = cell.robot;
  request.resume = true;
  const workflows::TrainReport report = workflows::TrainTask(request, progress);
  CellResult result;
  result.name = cell.name;
  result.samples = static_cast<double>(report.skills.front().samples);
  result.minutes = report.skills.front().seconds / 60.0;
  const fs::path policy = report.skills.front().folder / rl::kPolicyFile;
  result.unseen = EvaluateUnseen(cell, policy, arguments, workflows::kUnseenSeed, progress);
  if (arguments.ship) {
    const fs::path shipped = workflows::ShippedPolicy(arguments.models, cell.name);
    fs::create_directories(shipped.parent_path());
    rl::WritePolicy(rl::ReadPolicy(policy), shipped, rl::Precision::kHalf);
    core::WriteFile(fs::path(shipped).replace_extension(".md"), Card(cell, arguments, result));
    fs::copy_file(policy.parent_path() / rl::kCurvesFile,
                  fs::path(shipped).replace_extension(".svg"),
                  fs::copy_options::overwrite_existing);
  }
  return result;
}

void Print(const CellResult& result, core::Progress* progress) {
  progress->Finish();
  std::fputs(Row(result).c_str(), stdout);
  std::fflush(stdout);
}

// Evaluates the cell's shipped policy, or the expert, on each range of instances; prints a row for
// each and one for all.
void EvaluateRanges(const workflows::SuiteCell& cell, const Arguments& arguments,
                    core::Progress* progress) {
  std::optional<fs::path> policy;
  if (!arguments.script) policy = workflows::ShippedPolicy(arguments.models, cell.name);
  if (policy && !fs::exists(*policy)) return;
  CellResult all;
  all.name = cell.name + " (all)";
  double seconds = 0.0;  // of all successes
  for (const std::uint64_t first_seed : arguments.first_seeds) {
    CellResult result;
    result.name = cell.name;
    if (arguments.first_seeds.size() > 1) result.name += " " + std::to_string(first_seed);
    result.unseen = EvaluateUnseen(cell, policy, arguments, first_seed, progress);
    Print(result, progress);
    all.unseen.successes += result.unseen.successes;
    all.unseen.episodes.insert(all.unseen.episodes.end(), result.unseen.episodes.begin(),
                               result.unseen.episodes.end());
    seconds += result.unseen.seconds * result.unseen.successes;
  }
  if (arguments.first_seeds.size() == 1) return;
  all.unseen.seconds = seconds / std::max(1, all.unseen.successes);
  all.unseen.interval =
      rl::WilsonInterval(all.unseen.successes, static_cast<int>(all.unseen.episodes.size()));
  Print(all, progress);
}

void Run(const Arguments& arguments) {
  core::Progress progress(core::Progress::StyleForStderr());
  for (const workflows::SuiteCell& cell : workflows::SkillSuite()) {
    if (arguments.cell != "all" && arguments.cell != cell.name) continue;
    if (!arguments.train) {
      EvaluateRanges(cell, arguments, &progress);
      continue;
    }
    Print(Train(cell, arguments, &progress), &progress);
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Success of trained skills on unseen assets");
  simwright::Arguments arguments;
  app.add_option("--cell", arguments.cell, "One cell, or all")->capture_default_str();
  app.add_flag("--train", arguments.train, "Train the cell; else evaluate the shipped policy");
  app.add_flag("--script", arguments.script,
               "Evaluate the scripted expert that training starts from");
  app.add_option("--action", arguments.action, "Action space (train --help)")
      ->capture_default_str();
  app.add_option("--imitate", arguments.imitated,
                 "Initial decisions that imitate the scripted expert")
      ->capture_default_str();
  app.add_flag("--ship", arguments.ship, "Write policy, card and curves into models/skills");
  app.add_flag("--by-task", arguments.by_task, "Also print the success of each task");
  app.add_option("--minutes", arguments.minutes, "Training time; 0: the cell's own");
  app.add_option("--samples", arguments.samples, "Training decisions, at most")
      ->capture_default_str();
  app.add_option("--target", arguments.target,
                 "Lower bound of the success rate at which the training ends")
      ->capture_default_str();
  app.add_option("--instances", arguments.instances,
                 "Training instances; 0: the cell's own number");
  app.add_option("--finger-friction", arguments.finger_friction,
                 "Finger friction in the evaluation; 0: the robot's own, 2");
  app.add_option("--on-seeds", arguments.first_seeds,
                 "First seeds of the ranges of evaluation instances, each evaluated apart")
      ->capture_default_str();
  app.add_option("--range", arguments.range, "Evaluation instances of a range")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--episodes", arguments.episodes, "Episodes of the evaluation")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "Seed of the training")->capture_default_str();
  app.add_option("-o", arguments.output, "Output folder of assets and trainings")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    if (arguments.cell != "all") simwright::workflows::CellOf(arguments.cell);
    simwright::core::SetThreadCount(0);
    simwright::Run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
