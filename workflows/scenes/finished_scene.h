#pragma once

#include <filesystem>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/dataset/scene_shard.h"
#include "scene/grammar/scene_sample.h"
#include "workflows/scenes/scene_stability.h"

namespace simwright::workflows {

// A scene that stands still in both engines, or as much of it as was found to.
struct FinishedScene {
  std::vector<scene::SceneObject> objects;
  SceneStability stability;
  int dropped = 0;           // objects that moved
  double penetration = 0.0;  // m, the deepest
};

// Writes a shard with one scene.
void WriteSingleScene(const std::vector<scene::SceneObject>& objects,
                      const scene::Vocabulary& vocabulary, const scene::ShardOrigin& origin,
                      const scene::SceneAttempt& attempt, const std::filesystem::path& path);

// Checks a scene as `scene export --check` does. `assets`: a folder with an asset folder per
// category. Throws core::Error as ExportScenes does.
SceneStability CheckInBothEngines(const std::vector<scene::SceneObject>& objects,
                                  const scene::Vocabulary& vocabulary,
                                  const std::filesystem::path& assets);

// Returns the indices of the free objects that moved farthest in an engine in which the scene does
// not stand still; none if it does in both.
std::vector<size_t> MovingObjects(const std::vector<scene::SceneObject>& objects,
                                  const SceneStability& stability);

// Checks a scene in both engines; drops the objects that move, and what then moves in Bullet, until
// all others stand still. `assets`: a folder with an asset folder per category. Throws core::Error
// as ExportScenes does.
FinishedScene FinishScene(const std::vector<scene::SceneObject>& objects,
                          const scene::Vocabulary& vocabulary, const scene::AssetSet& asset_set,
                          const std::filesystem::path& assets);

}  // namespace simwright::workflows
