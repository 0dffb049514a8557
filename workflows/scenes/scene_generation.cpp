#include "workflows/scenes/scene_generation.h"

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "scene/dataset/generation.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/shard_claim.h"
#include "scene/scene_types/scene_types.h"
#include "workflows/scenes/scene_assets.h"
#include "workflows/scenes/scene_sheet.h"

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

// Returns the shard in its current state, or an empty one.
scene::SceneShard PartAt(const fs::path& path, const scene::Vocabulary& vocabulary,
                         const scene::ShardOrigin& origin) {
  if (!fs::exists(path)) return {vocabulary, origin, {}, {}};
  scene::SceneShard part = scene::SceneShardFile(path).ReadAll();
  if (!(part.vocabulary == vocabulary) || !part.origin.SameDataset(origin)) {
    throw core::Error("it contains scenes of another type, seed, asset set or settings",
                      path.string(), "generate into a new folder");
  }
  return part;
}

void MakePart(const scene::Generation& generation, int scenes, const fs::path& path,
              scene::SceneShard part, core::Progress* progress) {
  const size_t before = part.attempts.size();
  try {
    scene::ExtendShard(generation, scenes, &part, progress);
  } catch (const core::Cancelled&) {
    if (part.attempts.size() > before) scene::WriteShard(part, path);
    throw;
  }
  scene::WriteShard(part, path);
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
  scene::Generation generation{type.make(asset_set.Sizes()), &asset_set, {}};
  generation.raw = request.raw;
  if (request.time_step > 0.0) generation.feasibility.settling.time_step = request.time_step;
  scene::ShardOrigin origin;
  origin.seed = request.seed;
  origin.assets = AssetsText(asset_set, vocabulary);
  origin.settings = scene::SettingsText(generation);
  origin.program = SIMWRIGHT_VERSION;

  progress->Stage("scenes", request.count);
  int elsewhere = 0;
  for (int first = 0; first < request.count; first += request.part) {
    origin.part = first / request.part;
    const int scenes = std::min(request.part, request.count - first);
    const fs::path path = request.output / scene::ShardName(origin.part);
    const scene::ShardClaim claim(path);
    elsewhere += !claim.held();
    if (!claim.held()) continue;
    scene::SceneShard part = PartAt(path, vocabulary, origin);
    for (int i = 0; i < std::min(scenes, part.SceneCount()); ++i) progress->Advance();
    // A shard of an earlier version lacks prompts; they are added.
    const bool has_prompts = part.prompts.size() == static_cast<size_t>(part.SceneCount());
    if (part.SceneCount() >= scenes && has_prompts) continue;
    MakePart(generation, scenes, path, std::move(part), progress);
  }
  progress->Finish();

  const scene::SceneDataset dataset(request.output);
  SceneStatistics statistics = StatisticsOf(dataset.Attempts());
  statistics.type = request.type;
  statistics.physics = !request.raw;
  statistics.elsewhere = elsewhere;
  core::WriteFile(request.output / "statistics.json", StatisticsJson(statistics));
  WriteSceneSheet(dataset, asset_set, request.output / "scenes.png");
  statistics.findings = std::move(findings);
  const core::Findings dropped = DroppedFindings(statistics);
  statistics.findings.insert(statistics.findings.end(), dropped.begin(), dropped.end());
  return statistics;
}

}  // namespace simwright::workflows
