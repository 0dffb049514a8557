// Measures scenes far from feasible, like a model's samples: objects of several samples of a
// grammar, interpenetrating and perturbed. Reports the time of the depenetration, its success, and
// the time of 2.5 s of settling. Assets as kept by `simwright scene generate`.
//   bench_crowded_scenes --type dimsum --assets out/dimsum/assets --objects 34
//   bench_crowded_scenes --type restaurant_high --assets out/restaurant/assets --objects 120
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "scene/asset_set/asset_set_folder.h"
#include "scene/feasibility/depenetration.h"
#include "scene/grammar/scene_sample.h"
#include "scene/scene_types/scene_types.h"
#include "sim/settling.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string type = "dimsum", assets;
  int objects = 34, count = 20, settled = 3;
  scene::DepenetrationOptions projection;
  double shake = 0.02;  // m, standard deviation along each axis
  std::uint64_t seed = 1;
};

double MillisecondsSince(Clock::time_point start) {
  return 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
}

// Returns the objects of as many samples as needed for their number; the furniture of the first
// one.
std::vector<scene::SceneObject> Crowd(const scene::Grammar& grammar, const Arguments& arguments,
                                      core::Rng& rng) {
  std::vector<scene::SceneObject> crowd;
  for (bool first = true; static_cast<int>(crowd.size()) < arguments.objects; first = false) {
    for (scene::SceneObject& object : scene::SampleGrammar(grammar, rng).objects) {
      if ((object.welded && !first) || static_cast<int>(crowd.size()) == arguments.objects)
        continue;
      for (int axis = 0; axis < 3 && !object.welded; ++axis) {
        object.world_from_object.translation()[axis] += arguments.shake * core::Normal(rng);
      }
      crowd.push_back(object);
    }
  }
  return crowd;
}

void Measure(const Arguments& arguments) {
  const scene::SceneType& type = scene::SceneTypeNamed(arguments.type);
  const scene::AssetSet asset_set =
      scene::ReadAssetSet(scene::FoldersForCategories(arguments.assets, type.categories));
  const scene::Grammar grammar = type.make(asset_set.Sizes());
  std::vector<double> projection, settling;
  int feasible = 0, rounds = 0;
  double shift = 0.0;
  for (int k = 0; k < arguments.count; ++k) {
    core::Rng rng = core::StreamRng(arguments.seed, static_cast<std::uint64_t>(k));
    const std::vector<scene::SceneObject> crowd = Crowd(grammar, arguments, rng);
    std::vector<scene::ProjectedBody> bodies;
    for (const scene::SceneObject& object : crowd) {
      bodies.push_back(
          {&asset_set.At(object.category).parts, object.world_from_object, object.welded});
    }
    auto start = Clock::now();
    const scene::Projection depenetrated = scene::ResolvePenetrations(bodies, arguments.projection);
    projection.push_back(MillisecondsSince(start));
    feasible += depenetrated.feasible;
    rounds += depenetrated.rounds;
    for (const Eigen::Vector3d& one : depenetrated.shifts) shift += one.norm() / arguments.objects;
    if (k >= arguments.settled) continue;
    std::vector<sim::SettlingBody> settle;
    for (size_t i = 0; i < crowd.size(); ++i) {
      Eigen::Isometry3d pose = crowd[i].world_from_object;
      pose.pretranslate(depenetrated.shifts[i]);
      settle.push_back({&asset_set.At(crowd[i].category).body, pose, crowd[i].welded});
    }
    sim::SettlingOptions options;
    options.watch = options.rest_tolerance = options.early_stop_factor =
        0.0;  // the whole 2.5 s, and no more
    start = Clock::now();
    sim::Settle(settle, options);
    settling.push_back(MillisecondsSince(start));
  }
  std::sort(projection.begin(), projection.end());
  std::sort(settling.begin(), settling.end());
  std::printf("%s, %d objects, perturbed by %.0f mm: %d of %d depenetrated, %.1f rounds, %.0f mm\n",
              type.name.c_str(), arguments.objects, 1e3 * arguments.shake, feasible,
              arguments.count, static_cast<double>(rounds) / arguments.count,
              1e3 * shift / arguments.count);
  std::printf("one core: depenetration %.1f ms median, %.1f at most",
              projection[projection.size() / 2], projection.back());
  if (!settling.empty()) {
    std::printf("; 2.5 s of settling %.1f s median, %.1f at most",
                1e-3 * settling[settling.size() / 2], 1e-3 * settling.back());
  }
  std::printf("\n");
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Crowded scenes: time to make them feasible");
  simwright::Arguments arguments;
  app.add_option("--type", arguments.type, "Scene type")->capture_default_str();
  app.add_option("--assets", arguments.assets, "Folder of the categories' assets")->required();
  app.add_option("--objects", arguments.objects, "Objects per scene, furniture included")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--count", arguments.count, "Number of scenes, at least 1")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--settled", arguments.settled, "Number of them that settle too")
      ->capture_default_str();
  app.add_option("--shake", arguments.shake,
                 "Standard deviation of the perturbation along each axis, m")
      ->capture_default_str();
  app.add_option("--rounds", arguments.projection.rounds, "Depenetration rounds, at most")
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "Seed of the scenes")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::Measure(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
