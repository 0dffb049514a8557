#pragma once

#include <filesystem>
#include <vector>

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

}  // namespace simwright::workflows
