// Measures projections that keep the relations of crowded scenes, by the number of initial
// collisions: collisions left, relations that hold before and after, mean displacement and time on
// one core, with the relations as constraints and without. Scenes are samples of a grammar that
// have settled in simulation, and whose objects are then displaced at random. A relation of each
// object to one of its neighbours is asked for: it holds before the displacement, so that all can
// hold without collisions.
//   bench_kept_relations --type dimsum --assets out/dimsum/assets
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <set>

#include <CLI/CLI.hpp>

#include "scene/asset_set/asset_set_folder.h"
#include "scene/feasibility/depenetration.h"
#include "scene/feasibility/feasible_scene.h"
#include "scene/feasibility/narrow_phase.h"
#include "scene/grammar/scene_sample.h"
#include "scene/scene_types/scene_types.h"

namespace simwright {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string type = "dimsum", assets;
  int count = 200;          // scenes
  bool raw = false;         // without settling: samples of some grammars interpenetrate
  double shake = 0.06;      // m, largest standard deviation along each horizontal axis
  double colliding = 1e-3;  // m, depth from which two objects collide
  std::uint64_t seed = 1;
};

constexpr int kBuckets = 4, kBucketSize = 10;  // collisions

struct Bucket {
  int scenes = 0, relations = 0, initial = 0, broken = 0, left = 0;
  std::array<int, scene::kRelationCount> broken_by_relation{};
  double shift = 0.0;  // m, sum of the scenes' means
  std::vector<double> milliseconds;
};

std::vector<scene::SceneObject> Displaced(std::vector<scene::SceneObject> objects, double shake,
                                          core::Rng& rng) {
  for (scene::SceneObject& object : objects) {
    if (object.welded) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const double scale = axis == 2 ? 0.1 : 1.0;
      object.world_from_object.translation()[axis] += scale * shake * core::Normal(rng);
    }
  }
  return objects;
}

std::vector<scene::PlacedBox> BoxesOf(const std::vector<scene::SceneObject>& objects,
                                      const scene::CategorySizes& sizes) {
  std::vector<scene::PlacedBox> boxes;
  for (const scene::SceneObject& object : objects) {
    boxes.push_back(BoxOf(SizeOf(sizes, object.category), object.world_from_object));
  }
  return boxes;
}

// Returns one relation of each free object to a neighbour, both drawn uniformly, with the boxes of
// the displaced objects.
std::vector<scene::KeptRelation> RelationsOf(const std::vector<scene::SceneObject>& objects,
                                             const std::vector<scene::SceneObject>& displaced,
                                             const scene::CategorySizes& sizes, core::Rng& rng) {
  const std::vector<scene::PlacedBox> boxes = BoxesOf(objects, sizes);
  const std::vector<scene::PlacedBox> moved = BoxesOf(displaced, sizes);
  std::vector<scene::KeptRelation> kept;
  for (size_t i = 0; i < objects.size(); ++i) {
    std::vector<scene::KeptRelation> some;
    for (size_t j = 0; j < objects.size() && !objects[i].welded; ++j) {
      if (i == j || objects[j].welded) continue;
      for (const scene::Relation one : RelationsBetween(boxes[i], boxes[j])) {
        some.push_back({static_cast<int>(i), static_cast<int>(j), one, moved[i], moved[j]});
      }
    }
    if (some.empty()) continue;
    kept.push_back(
        some[static_cast<size_t>(core::UniformIndex(rng, static_cast<std::int64_t>(some.size())))]);
  }
  return kept;
}

// Returns the pairs of bodies that overlap by more than `depth`, m.
int Collisions(const std::vector<scene::ProjectedBody>& bodies,
               const std::vector<Eigen::Vector3d>& shifts, double depth) {
  scene::ConvexBodies all;
  for (const scene::ProjectedBody& body : bodies) {
    all.Add(*body.parts, body.world_from_body, body.fixed);
  }
  std::vector<scene::NarrowPhasePair> near;
  all.Find(shifts, -depth, &near);
  std::set<std::pair<int, int>> pairs;
  for (const scene::NarrowPhasePair& pair : near) pairs.insert({pair.a, pair.b});
  return static_cast<int>(pairs.size());
}

void MeasureScene(const std::vector<scene::ProjectedBody>& bodies,
                  const std::vector<scene::KeptRelation>& relations, bool constrained,
                  double colliding, Bucket* bucket) {
  const auto start = Clock::now();
  const scene::Projection projection =
      ResolvePenetrations(bodies, {}, constrained ? relations : std::vector<scene::KeptRelation>());
  bucket->milliseconds.push_back(1e3 * std::chrono::duration<double>(Clock::now() - start).count());
  ++bucket->scenes;
  bucket->relations += static_cast<int>(relations.size());
  for (const scene::KeptRelation& one : relations) {
    const bool holds = HoldsAfter(one, projection.shifts);
    bucket->broken += !holds;
    bucket->broken_by_relation[static_cast<size_t>(one.relation)] += !holds;
    bucket->initial += Holds(one.relation, one.subject_box, one.object_box);
  }
  bucket->left += Collisions(bodies, projection.shifts, std::min(colliding, 1e-4));
  double shift = 0.0, free = 0.0;
  for (size_t i = 0; i < bodies.size(); ++i) {
    shift += projection.shifts[i].norm();
    free += !bodies[i].fixed;
  }
  bucket->shift += shift / std::max(1.0, free);
}

// Returns sample k of the grammar, settled in simulation; empty if it is no valid scene.
std::vector<scene::SceneObject> Sampled(const scene::Grammar& grammar,
                                        const scene::AssetSet& asset_set,
                                        const Arguments& arguments, core::Rng& rng) {
  std::vector<scene::SceneObject> sample = scene::SampleGrammar(grammar, rng).objects;
  if (arguments.raw) return sample;
  scene::FeasibleScene feasible = MakeFeasible(sample, asset_set);
  return feasible.valid ? std::move(feasible.objects) : std::vector<scene::SceneObject>();
}

void Measure(const Arguments& arguments) {
  const scene::SceneType& type = scene::SceneTypeNamed(arguments.type);
  const scene::AssetSet asset_set =
      scene::ReadAssetSet(scene::FoldersForCategories(arguments.assets, type.categories));
  const scene::CategorySizes sizes = asset_set.Sizes();
  const scene::Grammar grammar = type.make(sizes);
  std::array<std::array<Bucket, kBuckets>, 2> table;
  for (int k = 0; k < arguments.count; ++k) {
    core::Rng rng = core::StreamRng(arguments.seed, static_cast<std::uint64_t>(k));
    const std::vector<scene::SceneObject> sample = Sampled(grammar, asset_set, arguments, rng);
    if (sample.empty()) continue;
    const std::vector<scene::SceneObject> objects =
        Displaced(sample, core::Uniform(rng) * arguments.shake, rng);
    std::vector<scene::ProjectedBody> bodies;
    for (const scene::SceneObject& object : objects) {
      bodies.push_back(
          {&asset_set.At(object.category).parts, object.world_from_object, object.welded});
    }
    const std::vector<Eigen::Vector3d> none(bodies.size(), Eigen::Vector3d::Zero());
    const int collisions = Collisions(bodies, none, arguments.colliding);
    const int at = collisions / kBucketSize;
    if (at >= kBuckets) continue;
    const std::vector<scene::KeptRelation> relations = RelationsOf(sample, objects, sizes, rng);
    for (const bool constrained : {false, true}) {
      MeasureScene(bodies, relations, constrained, arguments.colliding,
                   &table[constrained][static_cast<size_t>(at)]);
    }
  }
  std::printf("%-12s %-12s %7s %10s %8s %8s %12s %10s %10s\n", "collisions", "relations", "scenes",
              "relations", "before %", "after %", "left, scene", "shift mm", "ms");
  for (size_t at = 0; at < kBuckets; ++at) {
    for (const bool constrained : {false, true}) {
      Bucket& bucket = table[constrained][at];
      if (bucket.scenes == 0) continue;
      std::sort(bucket.milliseconds.begin(), bucket.milliseconds.end());
      std::printf(
          "%4zu to %-4zu %-12s %7d %10d %8.1f %8.2f %12.3f %10.1f %5.1f (%.1f)\n", at * kBucketSize,
          (at + 1) * kBucketSize, constrained ? "kept" : "ignored", bucket.scenes, bucket.relations,
          100.0 * bucket.initial / std::max(1, bucket.relations),
          100.0 - 100.0 * bucket.broken / std::max(1, bucket.relations),
          static_cast<double>(bucket.left) / bucket.scenes, 1e3 * bucket.shift / bucket.scenes,
          bucket.milliseconds[bucket.milliseconds.size() / 2], bucket.milliseconds.back());
      if (!constrained || bucket.broken == 0) continue;
      std::printf("             not kept:");
      for (size_t k = 0; k < bucket.broken_by_relation.size(); ++k) {
        if (bucket.broken_by_relation[k] == 0) continue;
        std::printf(" %s %d", scene::RelationText(static_cast<scene::Relation>(k)),
                    bucket.broken_by_relation[k]);
      }
      std::printf("\n");
    }
  }
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Projections that keep the relations of crowded scenes");
  simwright::Arguments arguments;
  app.add_option("--type", arguments.type, "Scene type")->capture_default_str();
  app.add_option("--assets", arguments.assets, "Folder of the categories' assets")->required();
  app.add_option("--count", arguments.count, "Number of scenes")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_flag("--raw", arguments.raw, "Displace samples that have not settled");
  app.add_option("--shake", arguments.shake,
                 "Largest standard deviation of the displacement along each horizontal axis, m; "
                 "a tenth of it in height")
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
