#pragma once

#include <filesystem>

#include "scene/asset_set/asset_set.h"
#include "steering/search/scene_search.h"

namespace simwright::workflows {

// Renders the scenes on the path from the root of a search to its best scene, from the side and
// evenly selected if there are more than twelve, into one PNG.
void WriteBestPath(const steering::SceneSearch& search, const scene::Vocabulary& vocabulary,
                   const scene::AssetSet& asset_set, const std::filesystem::path& path);

}  // namespace simwright::workflows
