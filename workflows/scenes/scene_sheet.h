#pragma once

#include <filesystem>

#include "scene/asset_set/asset_set.h"
#include "scene/dataset/scene_dataset.h"

namespace simwright::workflows {

// Renders the first twelve scenes of a dataset from the side into one PNG; writes nothing for an
// empty dataset.
void WriteSceneSheet(const scene::SceneDataset& dataset, const scene::AssetSet& asset_set,
                     const std::filesystem::path& path);

}  // namespace simwright::workflows
