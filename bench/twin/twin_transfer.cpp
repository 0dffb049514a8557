// Picks up an object of a rendered table by a motion that was made in a twin of the table, in the
// table itself: the motion that holds in most twins perturbed within the stated uncertainty, beside
// one that was chosen in the twin alone.
// The twin is the table itself, displaced and scaled within its uncertainty, or is rebuilt from the
// table's picture, with the true masks and the known camera. Motions are those of the scripted
// expert, or of policies trained with the twin's ranges and without randomization, for the same
// number of decisions at most. The object is the one that leaves the fingers most room over its
// uncertainty. If no motion holds in 90 % of the perturbed twins, the next object is tried; the one
// with the surest motion counts.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "tests/transfer/scripted_expert.h"
#include "transfer/motion_recording.h"
#include "transfer/pick_choice.h"
#include "transfer/twin_ranges.h"
#include "transfer/twin_tasks.h"
#include "transfer_table.h"
#include "twin/scene_sources.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"
#include "workflows/skills/skill_training.h"

namespace simwright::bench {
namespace {
namespace fs = std::filesystem;

constexpr std::uint64_t kHeldOut = 1'000'000'000;
constexpr int kMostTried = 10;  // tables, over those that are wanted
constexpr double kSigmas = 2.0;

struct Options {
  int count = 20, first = 0, episodes = 8, worlds = 16, objects = 1;
  double iou = 0.92;
  std::int64_t decisions = 150'000;  // the most of a training's subtask
  bool reconstruct = false, train = false, tuning = false, any_object = false;
  std::vector<fs::path> photos;
  fs::path keep;  // the twins stay there, by number; empty: nowhere
};

void AddOptions(CLI::App* app, Options* options) {
  app->add_option("--count", options->count, "Tables with an object that can be picked up")
      ->capture_default_str();
  app->add_option("--first", options->first, "Number of the first table")->capture_default_str();
  app->add_flag("--reconstruct", options->reconstruct, "Rebuild the twin from the table's picture");
  app->add_option("--iou", options->iou, "Agreement of the outlines that a displaced twin states")
      ->capture_default_str();
  app->add_flag("--train", options->train, "Motions of trained policies, not of the expert");
  app->add_option("--decisions", options->decisions, "The most decisions of a training's subtask")
      ->capture_default_str();
  app->add_option("--episodes", options->episodes, "Episodes whose motions are compared")
      ->capture_default_str();
  app->add_option("--worlds", options->worlds, "Perturbed twins in which they are compared")
      ->capture_default_str();
  app->add_option("--objects", options->objects, "Objects of a table that are tried, at most")
      ->capture_default_str();
  app->add_flag("--any-object", options->any_object, "Begin with the first that can be picked up");
  app->add_flag("--tuning", options->tuning, "Training seeds, not held-out ones");
  app->add_option("--photos", options->photos, "Pictures behind and below the objects");
  app->add_option("--keep", options->keep, "Folder in which the twins stay");
  app->add_option_function<int>("--threads", core::SetThreadCount, "Number of threads");
}

// The outcome of one table.
struct Outcome {
  std::string task;
  double position_error = 0.0;                                       // m, as the twin states it
  transfer::TransferRate plain, held;                                // in perturbed twins
  bool plain_succeeds = false, held_succeeds = false, acts = false;  // in the true table
};

// A pick-up task, and its object in the twin.
struct Pick {
  std::string task;
  size_t object = 0;
};

// Returns the tasks of picking up an object that stands for a true one, the surest first
// (SurestPicks), or in the order of the set.
std::vector<Pick> PicksOf(const tasks::TaskSet& set, const TransferTable& table, bool in_order) {
  std::vector<std::string> names = transfer::SurestPicks(set, table.twin);
  if (in_order) {
    const std::vector<std::string> any = names;
    names.clear();
    for (const tasks::Task& task : set.tasks) {
      if (std::find(any.begin(), any.end(), task.name) != any.end()) names.push_back(task.name);
    }
  }
  std::vector<Pick> picks;
  for (const std::string& name : names) {
    for (size_t k = 0; k < table.twin.objects.size(); ++k) {
      if (name == "pick_up_" + table.twin.objects[k].name && table.is_real[k]) {
        picks.push_back({name, k});
      }
    }
  }
  return picks;
}

// Returns the run of a task by the scripted expert, with the finger friction of training.
workflows::SkillRun ExpertRun(const tasks::TaskSet& set, const std::string& task,
                              const fs::path& folder) {
  workflows::SkillRun run = transfer::ExpertRun(set, task, folder);
  run.options.finger_friction = workflows::TrainRequest().finger_friction;
  return run;
}

// Returns a trained run.
workflows::SkillRun TrainedRun(const fs::path& tasks, const std::string& task, const fs::path& twin,
                               bool randomized, const fs::path& folder, std::int64_t decisions) {
  workflows::TrainRequest request;
  request.task_file = tasks;
  request.tasks = {task};
  request.output = folder;
  request.minutes = 0.0;  // the decisions alone limit it
  request.samples = decisions;
  request.placement_ranges = transfer::PlacementRanges(twin, kSigmas);
  request.randomized = randomized;
  core::Progress silent;
  workflows::TrainTask(request, &silent);
  return workflows::ReadRun(folder);
}

std::vector<rl::Policy> PoliciesFor(const transfer::TransferTask& task, bool trained) {
  if (trained) return transfer::PoliciesOf(task);
  return {transfer::ExpertPolicy(task)};
}

transfer::ChosenMotion Choose(const transfer::TransferTask& task,
                              const std::vector<rl::Policy>& policies, const TransferTable& table,
                              const fs::path& folder, const Options& options, std::uint64_t seed) {
  core::Progress silent;
  const transfer::MotionRecorder recorder(task, policies,
                                          transfer::PlacementRanges(folder, kSigmas));
  return transfer::ChooseMotion(recorder, task, transfer::PerturbedTwinOf(task, table.twin, folder),
                                options.episodes, options.worlds, seed, &silent);
}

// Makes motions of outcome->task in the twin and replays them in the table.
void TryTask(const TransferTable& table, const tasks::TaskSet& set, const fs::path& folder,
             const Options& options, std::uint64_t seed, Outcome* outcome) {
  const transfer::TransferWorld& truth = table.table;
  const fs::path tasks = folder / "tasks.json";
  const transfer::TransferTask task(
      options.train ? TrainedRun(tasks, outcome->task, folder, true,
                                 folder / (outcome->task + "_randomized"), options.decisions)
                    : ExpertRun(set, outcome->task, folder / "run"));
  const std::vector<rl::Policy> policies = PoliciesFor(task, options.train);
  if (policies.empty()) throw core::Error("the training left no policy", folder.string());
  core::Rng rng = core::StreamRng(seed, 1);
  outcome->acts = task.Acts(truth, {&policies.front()}, rng);
  const transfer::ChosenMotion chosen = Choose(task, policies, table, folder, options, seed);
  outcome->held = chosen.rate;
  outcome->held_succeeds = task.Replays(truth, chosen.motion);
  if (!options.train) {
    outcome->plain = chosen.first;
    outcome->plain_succeeds = task.Replays(truth, chosen.first_motion);
    return;
  }
  const transfer::TransferTask plain(TrainedRun(
      tasks, outcome->task, folder, false, folder / (outcome->task + "_plain"), options.decisions));
  const std::vector<rl::Policy> own = PoliciesFor(plain, true);
  const transfer::ChosenMotion first = Choose(plain, own, table, folder, options, seed);
  outcome->plain = first.first;
  outcome->plain_succeeds = plain.Replays(truth, first.first_motion);
}

// Returns none for a table whose twin has no object that can be picked up.
std::optional<Outcome> TryTable(const TransferTable& table, const fs::path& folder,
                                const Options& options, std::uint64_t seed) {
  core::Progress silent;
  transfer::TwinTasksRequest request;
  request.twin = folder;
  request.output = folder / "tasks.json";
  request.count = 50;
  const workflows::TasksReport made = transfer::MakeTwinTasks(request, &silent);
  std::optional<Outcome> best;
  int tried = 0;
  for (const Pick& pick : PicksOf(made.set, table, options.any_object)) {
    if (tried++ == options.objects) break;
    Outcome outcome;
    outcome.task = pick.task;
    outcome.position_error = table.twin.objects[pick.object].position_error;
    outcome.held.worlds = outcome.plain.worlds = options.worlds;
    try {
      TryTask(table, made.set, folder, options, seed, &outcome);
    } catch (const core::Error& error) {  // no motion: the robot would not be started
      std::printf("    %s: %s\n", pick.task.c_str(), error.what());
    }
    if (!best || outcome.held.successes > best->held.successes) best = outcome;
    if (best->held.rate() >= transfer::kHeldShare) break;
  }
  return best;
}

void PrintShare(const char* name, int count, int all) {
  const rl::Interval interval = rl::WilsonInterval(count, all);
  std::printf("%-44s %2d of %2d, %5.1f %% (%.1f to %.1f)\n", name, count, all,
              100.0 * count / std::max(1, all), 100.0 * interval.low, 100.0 * interval.high);
}

void Print(const std::vector<Outcome>& outcomes) {
  int plain = 0, held = 0, acts = 0;
  double plain_rate = 0.0, held_rate = 0.0;
  for (const Outcome& outcome : outcomes) {
    plain += outcome.plain_succeeds;
    held += outcome.held_succeeds;
    acts += outcome.acts;
    plain_rate += outcome.plain.rate() / static_cast<double>(outcomes.size());
    held_rate += outcome.held.rate() / static_cast<double>(outcomes.size());
  }
  const int all = static_cast<int>(outcomes.size());
  PrintShare("replayed in the true table, randomized", held, all);
  PrintShare("the same without randomization", plain, all);
  PrintShare("policy or expert acting in the true table", acts, all);
  std::printf("mean rate in perturbed twins: %.1f %%, without randomization %.1f %%\n",
              100.0 * held_rate, 100.0 * plain_rate);
}

void Run(const Options& options) {
  twin::TableSceneSources sources;
  sources.photos = twin::ReadScenePhotos(options.photos);
  std::unique_ptr<library_fit::LibraryPrior> prior;
  if (options.reconstruct) {
    prior = std::make_unique<library_fit::LibraryPrior>(
        workflows::LibraryWeights(workflows::ModelsFolder()));
  }
  twin::TableSceneOptions scene_options;
  scene_options.width = 640;
  scene_options.height = 480;
  scene_options.first_seed = options.tuning ? 1 : kHeldOut;
  if (options.tuning) scene_options.seeds = kHeldOut - 1;
  std::vector<Outcome> outcomes;
  int tables = 0;
  for (int number = options.first;
       static_cast<int>(outcomes.size()) < options.count && tables < kMostTried * options.count;
       ++number) {
    ++tables;
    core::Rng rng = core::StreamRng(options.tuning ? 80 : 79, static_cast<std::uint64_t>(number));
    const core::TemporaryFolder folder;
    const auto seed = static_cast<std::uint64_t>(10000 * (number + 1));
    const fs::path made =
        options.keep.empty() ? folder.path() / "twin" : options.keep / std::to_string(number);
    try {
      const twin::TableScene scene = twin::SampleTableScene(sources, scene_options, &rng);
      const TransferTable table =
          options.reconstruct
              ? ReconstructedTable(scene, sources, *prior, seed, made, folder.path() / "true")
              : PerturbedTable(scene, options.iou, seed, &rng, made);
      const std::optional<Outcome> outcome = TryTable(table, made, options, seed);
      if (!outcome) continue;
      std::printf("%3d %-32s +- %.1f cm; in twins %2d, without %2d of %d; in the table %s, %s\n",
                  number, outcome->task.c_str(), 100.0 * outcome->position_error,
                  outcome->held.successes, outcome->plain.successes, outcome->held.worlds,
                  outcome->held_succeeds ? "yes" : "no", outcome->plain_succeeds ? "yes" : "no");
      outcomes.push_back(*outcome);
    } catch (const core::Error& error) {
      std::printf("%3d %s\n", number, error.what());
    }
    std::fflush(stdout);
  }
  std::printf("%zu of %d tables have an object that can be picked up\n", outcomes.size(), tables);
  Print(outcomes);
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  CLI::App app("Motions made in twins, replayed in the true tables");
  simwright::bench::Options options;
  simwright::bench::AddOptions(&app, &options);
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::bench::Run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
