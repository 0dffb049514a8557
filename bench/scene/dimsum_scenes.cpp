// Samples dimsum tables from the grammar, depenetrates and settles them: how many are stable, and
// the time of each step. The tableware, and the table (else a drum), are read from a folder made by
//   simwright library --kind plate,cup,teapot,serving_dish,steamer,steamer_lid,table_round
//     -o FOLDER
#include <chrono>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/image.h"
#include "core/parallel.h"
#include "library/convex_shapes.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/export/scene_picture.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/scene_types/dimsum.h"

namespace simwright {
namespace {

struct Arguments {
  std::string assets, picture;
  std::vector<std::string> hulls;
  int count = 20;
  std::uint64_t seed = 1;
  double settle = 2.5, watch = 2.0, step = 1e-3;  // s
  bool whole = false;
};

struct Outcome {
  scene::SceneSample sample;
  scene::FeasibleScene scene;
  double sampling = 0.0, depenetration = 0.0, settling = 0.0;  // s
};

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

scene::AssetSet PaletteOf(const std::string& folder) {
  scene::AssetSet asset_set = scene::ReadAssetSet(folder);
  if (asset_set.Has("table_round")) return asset_set;
  const scene::CategorySize& size = scene::SizeOf(scene::DefaultCategorySizes(), "table_round");
  sim::RigidBody table;
  table.name = "table_round";
  table.friction = 0.6;
  const Eigen::Vector3d top(0.0, 0.0, size.height);
  table.parts = {library::Rod(top - Eigen::Vector3d(0.0, 0.0, 0.04), top, size.Radius(), 32)};
  if (!asset_set.Has("table_round")) asset_set.Add("table_round", table);
  return asset_set;
}

Outcome Make(const scene::Grammar& grammar, const scene::AssetSet& asset_set, int index,
             const Arguments& arguments) {
  Outcome outcome;
  core::Rng rng = core::StreamRng(arguments.seed, static_cast<std::uint64_t>(index));
  auto start = std::chrono::steady_clock::now();
  outcome.sample = scene::SampleGrammar(grammar, rng);
  outcome.sampling = SecondsSince(start);
  std::vector<scene::ProjectedBody> bodies;
  for (const scene::SceneObject& object : outcome.sample.objects) {
    bodies.push_back(
        {&asset_set.At(object.category).parts, object.world_from_object, object.welded});
  }
  start = std::chrono::steady_clock::now();
  scene::ResolvePenetrations(bodies);
  outcome.depenetration = SecondsSince(start);
  scene::FeasibilityOptions options;
  options.settling.duration = arguments.settle;
  options.settling.watch = arguments.watch;
  options.settling.time_step = arguments.step;
  if (arguments.whole) options.settling.rest_tolerance = options.settling.early_stop_factor = 0.0;
  start = std::chrono::steady_clock::now();
  outcome.scene = scene::MakeFeasible(outcome.sample.objects, asset_set, options);
  outcome.settling = SecondsSince(start) - outcome.depenetration;
  return outcome;
}

void Report(const std::vector<Outcome>& outcomes) {
  int sound = 0, projected = 0, dropped = 0;
  size_t sampled = 0, kept = 0, most = 0;
  double sampling = 0.0, depenetration = 0.0, settling = 0.0, moved = 0.0;
  for (const Outcome& one : outcomes) {
    sound += one.scene.valid;
    projected += one.scene.projected;
    dropped += one.scene.dropped;
    sampled += one.sample.objects.size();
    kept += one.scene.objects.size();
    most = std::max(most, one.scene.objects.size());
    sampling += one.sampling;
    depenetration += one.depenetration;
    settling += one.settling;
    moved += one.scene.moved;
  }
  const double n = static_cast<double>(outcomes.size());
  std::printf("scenes %zu, depenetrated %d, valid %d (%.1f %%)\n", outcomes.size(), projected,
              sound, 100.0 * sound / n);
  std::printf("objects sampled %.1f, kept %.1f on average, %zu at most; dropped %d\n", sampled / n,
              kept / n, most, dropped);
  std::printf("moved %.2f mm on average\n", 1e3 * moved / n);
  std::printf("per scene, one core: sampling %.1f ms, depenetration %.1f ms, settling %.2f s\n",
              1e3 * sampling / n, 1e3 * depenetration / n, settling / n);
}

void Run(const Arguments& arguments) {
  scene::AssetSet asset_set = PaletteOf(arguments.assets);
  for (const std::string& category : arguments.hulls) asset_set.UseConvexHullCollision(category);
  const scene::Grammar grammar = scene::DimsumTable(asset_set.Sizes());
  std::vector<Outcome> outcomes(static_cast<size_t>(arguments.count));
  core::ParallelFor(arguments.count, [&](int i) {
    outcomes[static_cast<size_t>(i)] = Make(grammar, asset_set, i, arguments);
  });
  Report(outcomes);
  for (size_t i = 0; i < outcomes.size(); ++i) {
    const scene::FeasibleScene& one = outcomes[i].scene;
    if (one.valid) continue;
    std::printf("not valid: scene %zu, dropped %d of %zu, drift %.2f mm, penetration %.3f mm\n", i,
                one.dropped, outcomes[i].sample.objects.size(), 1e3 * one.drift,
                1e3 * one.penetration);
  }
  if (arguments.picture.empty()) return;
  std::vector<core::Image> pictures;
  for (size_t i = 0; i < std::min<size_t>(8, outcomes.size()); ++i) {
    pictures.push_back(scene::RenderFromSide(outcomes[i].scene.objects, asset_set, 420));
  }
  core::WritePng(arguments.picture, core::ContactSheet(pictures, 4));
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Dimsum tables: sampled, depenetrated, settled");
  simwright::Arguments arguments;
  app.add_option("--assets", arguments.assets, "Folder of rigid assets")->required();
  app.add_option("--count", arguments.count, "Number of scenes")->capture_default_str();
  app.add_option("--seed", arguments.seed, "Seed of the scenes")->capture_default_str();
  app.add_option("--settle", arguments.settle, "Settling time, s")->capture_default_str();
  app.add_option("--watch", arguments.watch, "Duration of the stability check afterwards, s")
      ->capture_default_str();
  app.add_option("--step", arguments.step, "Simulation time step, s")->capture_default_str();
  app.add_option("--hull", arguments.hulls, "Categories that collide by their convex hull");
  app.add_flag("--whole", arguments.whole, "Never end settling or the stability check early");
  app.add_option("--picture", arguments.picture, "PNG of the first eight scenes");
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::core::SetThreadCount(0);
    simwright::Run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
