#include "workflows/scenes/finished_scene.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/files.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/feasibility/constrained_scene.h"
#include "scene/metrics/penetration.h"
#include "workflows/scenes/scene_export.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

// Drops what moves in Bullet with everything free.
void DropUnstable(const scene::AssetSet& asset_set, FinishedScene* finished) {
  scene::ConstrainedScene checked;
  checked.objects = finished->objects;
  checked.indices.resize(checked.objects.size());
  std::iota(checked.indices.begin(), checked.indices.end(), 0);
  CheckFree(std::vector<char>(checked.objects.size(), 0), asset_set, {}, &checked);
  finished->dropped += checked.dropped;
  finished->objects = std::move(checked.objects);
}

}  // namespace

void WriteSingleScene(const std::vector<scene::SceneObject>& objects,
                      const scene::Vocabulary& vocabulary, const scene::ShardOrigin& origin,
                      const scene::SceneAttempt& attempt, const fs::path& path) {
  scene::SceneShard part{vocabulary, origin, {}, {attempt}, {}};
  part.tokens.resize(static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth()));
  EncodeScene(objects, vocabulary, part.tokens.data());
  scene::WriteShard(part, path);
}

SceneStability CheckInBothEngines(const std::vector<scene::SceneObject>& objects,
                                  const scene::Vocabulary& vocabulary, const fs::path& assets) {
  const core::TemporaryFolder folder;
  const fs::path dataset = folder.path() / "scenes";
  fs::create_directories(dataset);
  WriteSingleScene(objects, vocabulary, {0, 0, "{}", "{}", ""},
                   {0, 0, 0, true, true, 0.0, 0.0, 0.0}, dataset / scene::ShardName(0));
  SceneExportRequest request;
  request.dataset = dataset;
  request.formats = {"mjcf"};
  request.output = folder.path() / "export";
  request.assets = assets;
  request.check = true;
  core::Progress silent;
  return ExportScenes(request, &silent).checks.front();
}

std::vector<size_t> MovingObjects(const std::vector<scene::SceneObject>& objects,
                                  const SceneStability& stability) {
  std::map<std::string, int> counts;
  std::vector<size_t> moving;
  for (size_t i = 0; i < objects.size(); ++i) {
    const std::string& category = objects[i].category;
    const std::string name = category + "_" + std::to_string(counts[category]++);
    const bool moved = (!stability.StableInMujoco() && name == stability.mujoco.name) ||
                       (!stability.StableInBullet() && name == stability.bullet.name);
    if (moved && !objects[i].welded) moving.push_back(i);
  }
  return moving;
}

FinishedScene FinishScene(const std::vector<scene::SceneObject>& objects,
                          const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
                          const fs::path& assets) {
  constexpr int kMostRounds = 8;
  FinishedScene finished;
  finished.objects = objects;
  for (int round = 0; round < kMostRounds; ++round) {
    if (round > 0) DropUnstable(asset_set, &finished);
    finished.stability = CheckInBothEngines(finished.objects, vocabulary, assets);
    const std::vector<size_t> moving = MovingObjects(finished.objects, finished.stability);
    if (moving.empty()) break;
    for (size_t i = moving.size(); i-- > 0;) {
      finished.objects.erase(finished.objects.begin() + static_cast<std::ptrdiff_t>(moving[i]));
    }
    finished.dropped += static_cast<int>(moving.size());
  }
  for (const scene::PenetratingPair& pair :
       scene::PenetratingPairs(finished.objects, asset_set, 0.0)) {
    finished.penetration = std::max(finished.penetration, pair.depth);
  }
  return finished;
}

}  // namespace simwright::workflows
