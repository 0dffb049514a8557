// Scenes far from feasible, as a model's samples are: things of several draws of a grammar on one
// another's places, shaken. How long it takes to move them apart, whether that succeeds, and how
// long 2.5 s of settling take. Assets as `simwright scene generate` keeps them.
//   bench_crowded_scenes --type dimsum --assets out/dimsum/assets --objects 34
//   bench_crowded_scenes --type restaurant_high --assets out/restaurant/assets --objects 120
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "scene/grammar/scene_draw.h"
#include "scene/grammar/scene_types.h"
#include "scene/palette_folder.h"
#include "scene/projection.h"
#include "sim/settling.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string type = "dimsum", assets;
  int objects = 34, count = 20, settled = 3;
  scene::ProjectionOptions projection;
  double shake = 0.02;  // m, the deviation along each axis
  std::uint64_t seed = 1;
};

double MillisecondsSince(Clock::time_point start) {
  return 1e3 * std::chrono::duration<double>(Clock::now() - start).count();
}

// Things of as many draws as it takes to have so many; the furniture of the first.
std::vector<scene::DrawnObject> Crowd(const scene::Grammar& grammar, const Arguments& arguments,
                                      core::Rng& rng) {
  std::vector<scene::DrawnObject> crowd;
  for (bool first = true; static_cast<int>(crowd.size()) < arguments.objects; first = false) {
    for (scene::DrawnObject& object : scene::DrawScene(grammar, rng).objects) {
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
  const scene::Palette palette =
      scene::ReadPalette(scene::FoldersForSlots(arguments.assets, type.slots));
  const scene::Grammar grammar = type.make(palette.Sizes());
  std::vector<double> projection, settling;
  int feasible = 0, rounds = 0;
  double shift = 0.0;
  for (int k = 0; k < arguments.count; ++k) {
    core::Rng rng = core::StreamRng(arguments.seed, static_cast<std::uint64_t>(k));
    const std::vector<scene::DrawnObject> crowd = Crowd(grammar, arguments, rng);
    std::vector<scene::ProjectedBody> bodies;
    for (const scene::DrawnObject& object : crowd) {
      bodies.push_back({&palette.At(object.slot).parts, object.world_from_object, object.welded});
    }
    auto start = Clock::now();
    const scene::Projection apart = scene::ProjectApart(bodies, arguments.projection);
    projection.push_back(MillisecondsSince(start));
    feasible += apart.feasible;
    rounds += apart.rounds;
    for (const Eigen::Vector3d& one : apart.shifts) shift += one.norm() / arguments.objects;
    if (k >= arguments.settled) continue;
    std::vector<sim::SettlingBody> settle;
    for (size_t i = 0; i < crowd.size(); ++i) {
      Eigen::Isometry3d pose = crowd[i].world_from_object;
      pose.pretranslate(apart.shifts[i]);
      settle.push_back({&palette.At(crowd[i].slot).body, pose, crowd[i].welded});
    }
    sim::SettlingOptions options;
    options.watch = options.resting = options.pace = 0.0;  // all of the 2.5 s, and no more
    start = Clock::now();
    sim::Settle(settle, options);
    settling.push_back(MillisecondsSince(start));
  }
  std::sort(projection.begin(), projection.end());
  std::sort(settling.begin(), settling.end());
  std::printf("%s, %d things, shaken by %.0f mm: %d of %d moved apart, %.1f rounds, %.0f mm\n",
              type.name.c_str(), arguments.objects, 1e3 * arguments.shake, feasible,
              arguments.count, static_cast<double>(rounds) / arguments.count,
              1e3 * shift / arguments.count);
  std::printf("one core: projection %.1f ms in the median, %.1f at most",
              projection[projection.size() / 2], projection.back());
  if (!settling.empty()) {
    std::printf("; 2.5 s of settling %.1f s in the median, %.1f at most",
                1e-3 * settling[settling.size() / 2], 1e-3 * settling.back());
  }
  std::printf("\n");
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Crowded scenes: how long it takes to make them feasible");
  simwright::Arguments arguments;
  app.add_option("--type", arguments.type, "Of scene")->capture_default_str();
  app.add_option("--assets", arguments.assets, "Folder of the slots' assets")->required();
  app.add_option("--objects", arguments.objects, "Of a scene, furniture included")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--count", arguments.count, "Scenes, at least 1")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--settled", arguments.settled, "Of these, how many settle too")
      ->capture_default_str();
  app.add_option("--shake", arguments.shake, "m, deviation along each axis")->capture_default_str();
  app.add_option("--rounds", arguments.projection.rounds, "At most")->capture_default_str();
  app.add_option("--seed", arguments.seed, "Of the scenes")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::Measure(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
