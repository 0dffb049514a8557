#include "workflows/scenes/scene_generation.h"

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "scene/dataset/generation.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_sheet.h"
#include "workflows/scenes/shard_work.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

void ValidateGeneration(const SceneGenerationRequest& request) {
  if (request.count < 1) throw core::Error("a dataset needs at least 1 scene", "--count");
  if (request.part < 1) throw core::Error("a shard needs at least 1 scene", "--part");
  if (request.time_step < 0.0) throw core::Error("a time step must be above 0 s", "--step");
}

// Checks the categories early, before the minutes of gathering assets.
void CheckHulls(const std::vector<std::string>& hulls, const scene::Vocabulary& vocabulary) {
  std::string known;
  for (const std::string& category : vocabulary.categories)
    known += (known.empty() ? "" : ", ") + category;
  for (const std::string& category : hulls) {
    if (std::count(vocabulary.categories.begin(), vocabulary.categories.end(), category) > 0)
      continue;
    throw core::Error("scenes of " + vocabulary.type + " have no such category",
                      "--hull " + category, "one of " + known);
  }
}

std::string AssetsText(const scene::AssetSet& asset_set, const scene::Vocabulary& vocabulary) {
  core::OrderedJson json;
  for (const std::string& category : vocabulary.categories)
    json[category] = asset_set.HashOf(category);
  return core::JsonLine(json);
}

// Returns the dataset of a request, whose assets are `asset_set`.
ShardedDataset DatasetOf(const SceneGenerationRequest& request, const scene::AssetSet& asset_set,
                         const scene::SceneType& type) {
  ShardedDataset dataset;
  dataset.folder = request.output;
  dataset.generation = {type.make(asset_set.Sizes()), &asset_set, {}};
  dataset.generation.raw = request.raw;
  if (request.time_step > 0.0)
    dataset.generation.feasibility.settling.time_step = request.time_step;
  dataset.vocabulary = VocabularyOf(type.make(scene::DefaultCategorySizes()));
  dataset.origin.seed = request.seed;
  dataset.origin.assets = AssetsText(asset_set, dataset.vocabulary);
  dataset.origin.settings = scene::SettingsText(dataset.generation);
  dataset.origin.program = SIMWRIGHT_VERSION;
  dataset.scenes = request.count;
  dataset.scenes_per_shard = request.part;
  return dataset;
}

}  // namespace

SceneStatistics StatisticsOf(const std::vector<scene::SceneAttempt>& attempts) {
  const scene::FeasibilityOptions limits;
  SceneStatistics statistics;
  double drawn = 0.0;  // in accepted scenes
  const auto count = [](int objects, std::vector<int>* counts) {
    if (static_cast<size_t>(objects) >= counts->size()) counts->resize(objects + 1, 0);
    ++(*counts)[static_cast<size_t>(objects)];
  };
  for (const scene::SceneAttempt& one : attempts) {
    ++statistics.attempts;
    statistics.mean_drawn += one.sampled;
    count(one.sampled, &statistics.drawn_counts);
    const bool accepted =
        one.penetration <= limits.penetration && one.drift <= limits.settling.stable;
    statistics.too_few += accepted && !one.valid;
    if (!one.valid) continue;
    ++statistics.scenes;
    statistics.mean_objects += one.kept;
    statistics.most_objects = std::max(statistics.most_objects, one.kept);
    statistics.dropped += one.dropped;
    drawn += one.kept + one.dropped;
    statistics.moved += one.moved;
    statistics.penetration = std::max(statistics.penetration, one.penetration);
    statistics.drift = std::max(statistics.drift, one.drift);
    count(one.kept, &statistics.scene_counts);
  }
  if (statistics.attempts > 0) {
    statistics.yield = static_cast<double>(statistics.scenes) / statistics.attempts;
    statistics.mean_drawn /= statistics.attempts;
  }
  if (drawn > 0.0) statistics.kept = 1.0 - statistics.dropped / drawn;
  if (statistics.scenes > 0) {
    statistics.mean_objects /= statistics.scenes;
    statistics.dropped /= statistics.scenes;
    statistics.moved /= statistics.scenes;
  }
  return statistics;
}

SceneStatistics GenerateScenes(const SceneGenerationRequest& request, core::Progress* progress) {
  ValidateGeneration(request);
  const scene::SceneType& type = scene::SceneTypeNamed(request.type);
  // The categories do not depend on the sizes.
  const scene::Vocabulary vocabulary = VocabularyOf(type.make(scene::DefaultCategorySizes()));
  CheckHulls(request.hulls, vocabulary);
  core::Findings findings;
  const scene::CategoryFolders folders = GatherSceneAssets(
      {vocabulary.categories, request.chosen, request.assets, request.output / "assets", &findings},
      progress);
  scene::AssetSet asset_set = scene::ReadAssetSet(folders);
  for (const std::string& category : request.hulls) asset_set.UseConvexHullCollision(category);
  const ShardedDataset sharded = DatasetOf(request, asset_set, type);

  progress->Stage("scenes", request.count);
  ShardWork work(sharded, request.place, progress);
  work.MakeUnclaimed();
  if (request.place.leads() && request.place.world_size > 1) work.WaitForOthers();
  progress->Finish();
  // One rank reports for all, and of an array the task that ends last.
  if (!request.place.leads() || (request.place.array_tasks > 1 && work.elsewhere() > 0)) {
    SceneStatistics unreported;
    unreported.reported = false;
    unreported.elsewhere = work.elsewhere();
    return unreported;
  }

  const scene::SceneDataset dataset(request.output);
  SceneStatistics statistics = StatisticsOf(dataset.Attempts());
  statistics.type = request.type;
  statistics.physics = !request.raw;
  statistics.elsewhere = work.elsewhere();
  core::WriteFile(request.output / "statistics.json", StatisticsJson(statistics));
  WriteSceneSheet(dataset, asset_set, request.output / "scenes.png");
  statistics.findings = std::move(findings);
  const core::Findings dropped = DroppedFindings(statistics);
  statistics.findings.insert(statistics.findings.end(), dropped.begin(), dropped.end());
  return statistics;
}

}  // namespace simwright::workflows
