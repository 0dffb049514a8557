#pragma once

#include <filesystem>
#include <vector>

#include "scene/grammar/category_size.h"
#include "scene/model/asset_shapes.h"

namespace simwright::workflows {

// Samples `points` points on the surface of an asset's solid. Throws core::Error if the folder has
// no asset.
std::vector<Eigen::Vector3d> ShapeOfAsset(const std::filesystem::path& folder, int points);

// Samples surface points of the assets of the dataset at `path`, by category. The assets are in
// `assets` or, if that is empty, in the folder "assets" beside the shards. Throws core::Error as
// FoldersOfCategories and ShapeOfAsset do.
scene::AssetShapes ShapesOfDataset(const std::filesystem::path& path,
                                   const std::filesystem::path& assets,
                                   const scene::Vocabulary& vocabulary, int points);

// Returns the sizes of the assets of the dataset at `path`: of `assets` or, if that is empty, of
// the folder "assets" beside the shards; default sizes for categories without an asset there, and
// if there is no such folder.
scene::CategorySizes SizesOfDataset(const std::filesystem::path& path,
                                    const std::filesystem::path& assets,
                                    const scene::Vocabulary& vocabulary);

}  // namespace simwright::workflows
