#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::workflows {

// Parses a list of scene indices such as "0,3-5", in its order without duplicates. Throws
// core::Error if `text` is not such a list or names a scene beyond a dataset of `count` scenes.
std::vector<int> ParseSceneIndices(const std::string& text, int count);

// Returns scene `index` of the dataset. Throws core::Error if it does not exist or is damaged.
std::vector<scene::SceneObject> SceneAt(const scene::SceneDataset& dataset, int index);

// Returns the asset folder of each category in `categories`: `assets`/SLOT, or, if `assets` is
// empty, in the folder "assets" beside the shards of the dataset at `path`. Throws core::Error if
// there is no such folder, a category has no asset there (naming it), or a category is not a valid
// folder name.
scene::CategoryFolders FoldersOfCategories(const std::filesystem::path& path,
                                           const std::filesystem::path& assets,
                                           const std::set<std::string>& categories);

// Throws core::Error, naming the category, if a category's asset is not the one that the dataset's
// scenes were made with. A dataset that does not record its assets passes.
void RequireSameAssets(const scene::SceneDataset& dataset, const scene::AssetSet& asset_set,
                       const std::set<std::string>& categories);

}  // namespace simwright::workflows
