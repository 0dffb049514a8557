// Searches for full scenes with several seeds: the iteration at which the goal was reached, the
// time of an iteration, the best of as many unconditional samples, and whether the finished scene
// passes the check in both engines. Draws the curves.
//   simwright scene generate --type dimsum --count 12 --seed 77 -o out/dimsum
//   bench_scene_search --weights models/scenes/dimsum.pt --assets out/dimsum/assets --random
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/elapsed_time.h"
#include "core/files.h"
#include "core/line_plot.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_shard.h"
#include "scene/dataset/tokens.h"
#include "scene/model/scene_model.h"
#include "steering/rewards/scene_rewards.h"
#include "steering/search/scene_search.h"
#include "workflows/scenes/finished_scene.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

struct Arguments {
  fs::path weights, assets, curves, scenes;
  int seeds = 5, first_seed = 1, steps = 50;
  std::string mask = "empty,penetrating,unstable";
  double eta = 1.0, sideways = 0.15;
  bool random = false, unrepaired = false, unconfirmed = false, one = false, unscaled = false,
       verbose = false;
  steering::SearchOptions search;
};

// A finished search.
struct Outcome {
  std::vector<steering::SearchRecord> records;
  double reward = 0.0, model = 0.0, physics = 0.0, seconds = 0.0;
  steering::TokenScene best;
  bool confirmed = false, reached = false;
};

class SearchBench {
 public:
  explicit SearchBench(const Arguments& arguments)
      : arguments_(arguments),
        asset_set_(scene::ReadAssetSet(arguments.assets)),
        model_(scene::SceneModel::Load(arguments.weights)),
        mask_(steering::MaskNamed(arguments.mask, vocabulary())),
        reward_(steering::FeasibleCountReward(vocabulary())) {}

  void Run() {
    std::printf("%4s %10s %10s %8s %8s %9s %9s %9s %8s\n", "seed", "iteration", "best", "random",
                "checked", "s/iter", "model s", "physics s", "samples/s");
    int reached = 0;
    scene::SceneShard part{vocabulary(), {0, 0, "{}", "{}", "bench"}, {}, {}, {}};
    for (int i = 0; i < arguments_.seeds; ++i) {
      const int seed = arguments_.first_seed + i;
      const Outcome found = Search(static_cast<std::uint64_t>(seed), false, 0);
      Outcome random;
      if (arguments_.random) {
        random =
            Search(static_cast<std::uint64_t>(seed), true, static_cast<int>(found.records.size()));
      }
      Print(seed, found, random);
      reached += found.reached;
      model_seconds_ += found.model;
      samples_ += found.records.empty() ? 0.0 : found.records.back().samples;
      curves_.push_back(found.records);
      if (arguments_.random) random_curves_.push_back(random.records);
      Append(found.best, &part);
      part.attempts.push_back({0, 0, 0, true, true, 0.0, 0.0, 0.0});
      if (!arguments_.scenes.empty()) {
        fs::create_directories(arguments_.scenes);
        scene::WriteShard(part, arguments_.scenes / "part_00000.h5");
      }
      if (!arguments_.curves.empty()) core::WriteFile(arguments_.curves, Curves());
    }
    std::printf("%d of %d searches reached %g\n", reached, arguments_.seeds, reward_->Goal());
    PrintPlainSampler();
  }

 private:
  const scene::Vocabulary& vocabulary() const { return model_.metadata().vocabulary; }

  std::vector<float> Inpaint(const std::vector<float>& tokens, const scene::InpaintingMask& mask,
                             std::uint64_t seed) const {
    scene::SampleOptions options;
    options.steps = arguments_.steps;
    options.eta = arguments_.eta;
    options.seed = seed;
    options.one_by_one = true;
    core::Progress progress;
    return model_.Inpaint(tokens, mask, options, &progress);
  }

  // Prints the rate of unconditional samples in batches. A sample of the search passes the same
  // entries through the same network as often: the ratio of their FLOP/s is that of the samples/s.
  void PrintPlainSampler() const {
    constexpr int kSamples = 128;
    scene::SampleOptions options;
    options.steps = arguments_.steps;
    options.eta = arguments_.eta;
    core::Progress progress;
    model_.Sample(options.batch, options, &progress);  // warms up
    const core::SteadyTime start = core::Now();
    model_.Sample(kSamples, options, &progress);
    const double plain = kSamples / core::SecondsSince(start);
    const double search = model_seconds_ > 0.0 ? samples_ / model_seconds_ : 0.0;
    std::printf("plain sampler %.1f samples/s, in searches %.1f: ratio of FLOP/s %.2f\n", plain,
                search, search / plain);
  }

  // Appends a scene as the check in both engines saw it: stacks are sensitive to rounding.
  void Append(const steering::TokenScene& scene, scene::SceneShard* part) const {
    std::vector<float> tokens = scene.tokens;
    EncodeScene(scene.Judged(vocabulary()).objects, vocabulary(), tokens.data());
    part->tokens.insert(part->tokens.end(), tokens.begin(), tokens.end());
  }

  Outcome Search(std::uint64_t seed, bool random, int iterations) const {
    steering::SearchOptions options = arguments_.search;
    options.seed = seed;
    options.random = random;
    options.confirms = !arguments_.unconfirmed;
    options.backs_up_all = !arguments_.one;
    options.scaled = !arguments_.unscaled;
    if (iterations > 0) options.iterations = iterations;
    steering::RepairOptions repair;
    repair.most_sideways = arguments_.sideways;
    if (arguments_.unrepaired) repair.repair = steering::Repair::kNone;
    const core::SteadyTime start = core::Now();
    steering::SceneSearch search(
        vocabulary(), asset_set_, *mask_, *reward_,
        [&](const auto& tokens, const auto& mask, std::uint64_t s) {
          return Inpaint(tokens, mask, s);
        },
        options, repair);
    search.SetFinalCheck([&](const std::vector<scene::SceneObject>& objects) {
      return workflows::MovingObjects(
          objects, workflows::CheckInBothEngines(objects, vocabulary(), arguments_.assets));
    });
    search.Start();
    while (!search.Finished()) {
      search.Iterate();
      if (!arguments_.verbose || search.IterationCount() % 20 != 0) continue;
      const size_t depth = search.tree().PathTo(search.best()).size() - 1;
      std::printf("  %s %d: best %g at depth %zu, last %g, %.2f s/iter\n",
                  random ? "random" : "search", search.IterationCount(), search.best_reward(),
                  depth, search.records().back().reward,
                  (search.model_seconds() + search.physics_seconds()) / search.IterationCount());
      std::fflush(stdout);
    }
    Outcome outcome{search.records(),
                    search.best_reward(),
                    search.model_seconds(),
                    search.physics_seconds(),
                    0.0,
                    search.scenes()[static_cast<size_t>(search.best())]};
    outcome.seconds = core::SecondsSince(start);
    outcome.reached = search.ReachedGoal();
    steering::TokenScene again = outcome.best;
    outcome.confirmed = ConfirmScene(vocabulary(), asset_set_, repair, &again) &&
                        workflows::CheckInBothEngines(again.Judged(vocabulary()).objects,
                                                      vocabulary(), arguments_.assets)
                            .Still();
    return outcome;
  }

  void Print(int seed, const Outcome& found, const Outcome& random) const {
    const auto iterations = static_cast<double>(std::max<size_t>(1, found.records.size()));
    char best_random[16] = "-";
    if (arguments_.random) std::snprintf(best_random, sizeof best_random, "%g", random.reward);
    std::printf("%4d %10s %10g %8s %8s %9.3f %9.3f %9.3f %8.1f\n", seed,
                found.reached ? std::to_string(found.records.size()).c_str() : "-", found.reward,
                best_random, found.confirmed ? "stable" : "NOT", found.seconds / iterations,
                found.model / iterations, found.physics / iterations,
                found.records.empty() ? 0.0 : found.records.back().samples / found.model);
    std::fflush(stdout);
  }

  std::string Curves() const {
    core::PlotPanel panel{50.0, 380.0, 0.0, reward_->Goal() * 1.03, 1.0};
    for (const auto& records : curves_) {
      panel.last = std::max(panel.last, static_cast<double>(records.size()));
    }
    std::string body = PlotAxes(panel, reward_->Name());
    const auto draw = [&](const auto& curves, const char* style) {
      for (const auto& records : curves) {
        core::PlotPoints points;
        for (const size_t i : core::PlotIndices(records.size())) {
          points.emplace_back(static_cast<double>(i + 1), records[i].best);
        }
        body += PlotCurve(panel, points, style);
      }
    };
    draw(random_curves_, "random");
    draw(curves_, "search");
    return core::PlotPage("Scene search: best so far by iteration, blue; random samples, grey",
                          ".search{fill:none;stroke:#1f6fb2;stroke-width:2}"
                          ".random{fill:none;stroke:#999;stroke-width:2}",
                          body, 420.0);
  }

  const Arguments& arguments_;
  scene::AssetSet asset_set_;
  scene::SceneModel model_;
  std::unique_ptr<steering::MaskGenerator> mask_;
  std::unique_ptr<steering::SceneReward> reward_;
  std::vector<std::vector<steering::SearchRecord>> curves_, random_curves_;
  double model_seconds_ = 0.0, samples_ = 0.0;  // of all searches
};

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Tree search for full scenes");
  simwright::Arguments arguments;
  int threads = 0;
  app.add_option("--weights", arguments.weights, "Weights of a scene model")->required();
  app.add_option("--assets", arguments.assets, "Folder of the assets by category")->required();
  app.add_option("--seeds", arguments.seeds, "Searches")->capture_default_str();
  app.add_option("--first-seed", arguments.first_seed, "First seed")->capture_default_str();
  app.add_option("--iterations", arguments.search.iterations, "Most iterations")
      ->capture_default_str();
  app.add_option("--branching", arguments.search.branching, "Children")->capture_default_str();
  app.add_option("--exploration", arguments.search.exploration, "Exploration constant")
      ->capture_default_str();
  app.add_option("--leaves", arguments.search.leaves, "Leaves per iteration")
      ->capture_default_str();
  app.add_option("--fill", arguments.search.fill, "Most entries filled per child")
      ->capture_default_str();
  app.add_option("--mask", arguments.mask, "Masks")->capture_default_str();
  app.add_option("--steps", arguments.steps, "Diffusion steps")->capture_default_str();
  app.add_option("--eta", arguments.eta, "Share of the noise")->capture_default_str();
  app.add_option("--sideways", arguments.sideways, "Most sideways displacement of a repair, m")
      ->capture_default_str();
  app.add_option("--threads", threads, "Threads; 0: all");
  app.add_flag("--random", arguments.random, "Also draw as many unconditional samples");
  app.add_flag("--unrepaired", arguments.unrepaired, "Judge samples as they are");
  app.add_flag("--unconfirmed", arguments.unconfirmed, "No check of new best scenes");
  app.add_flag("--one", arguments.one, "Backpropagate one child per expansion");
  app.add_flag("--unscaled", arguments.unscaled, "UCT on the rewards as they are");
  app.add_flag("--verbose", arguments.verbose, "Print a line every 20 iterations");
  app.add_option("--curves", arguments.curves, "SVG of the curves");
  app.add_option("--scenes", arguments.scenes, "Dataset of the best scenes");
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::core::InstallCancelHandler();
    simwright::core::SetThreadCount(threads);
    simwright::SearchBench(arguments).Run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
