#pragma once

#include <filesystem>
#include <vector>

#include "scene/asset_set/asset_set.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::workflows {

// A scene before and after a command changed it.
struct ScenePair {
  std::vector<scene::SceneObject> before, after;
};

// Renders scenes before and after: "before_after.png" has a row for each of the first six pairs,
// from the side; a single pair has a second row, from above. "scenes.png" has the first twelve
// scenes after, as WriteSceneSheet makes it. Writes both into `folder`. Throws core::Error for a
// scene without objects or a category without an asset.
void WriteBeforeAfter(const std::vector<ScenePair>& pairs, const scene::AssetSet& asset_set,
                      const std::filesystem::path& folder);

}  // namespace simwright::workflows
