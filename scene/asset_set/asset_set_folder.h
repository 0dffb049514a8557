#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scene/asset_set/asset_set.h"

namespace simwright::scene {

// Reads the asset set of the rigid asset folders in `folder` (docs/formats.md): "teapot_3" is an
// asset of the category "teapot"; of several for one category the first by name is used. Other
// files are ignored. Throws core::Error if the folder cannot be read, an asset is damaged, or there
// is none.
AssetSet ReadAssetSet(const std::filesystem::path& folder);

// Asset folders by category.
using CategoryFolders = std::map<std::string, std::filesystem::path>;

// Returns a rigid asset folder in `folder` for each of `categories`: the one of that name
// ("apple"), else the first with that name and a seed ("apple_7", unless that is a category
// itself), else the first whose asset has that category. Categories without a folder are omitted.
// Throws core::Error if the folder or the description of an asset cannot be read.
CategoryFolders FoldersForCategories(const std::filesystem::path& folder,
                                     const std::vector<std::string>& categories);

// Reads the asset set of these folders. Throws core::Error if an asset is damaged or has no
// collision parts.
AssetSet ReadAssetSet(const CategoryFolders& folders);

}  // namespace simwright::scene
