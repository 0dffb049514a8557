#pragma once

#include <filesystem>
#include <vector>

#include "scene/model/asset_shapes.h"

namespace simwright::pipeline {

// `points` of the surface of an asset's solid. Throws core::Error where the folder holds no asset.
std::vector<Eigen::Vector3d> ShapeOfAsset(const std::filesystem::path& folder, int points);

// Surfaces of what stands for the slots of the dataset at `path`, of the assets in `assets`, or
// where that is empty in the folder "assets" beside its parts. Throws core::Error as FoldersOfSlots
// and ShapeOfAsset do.
scene::AssetShapes ShapesOfDataset(const std::filesystem::path& path,
                                   const std::filesystem::path& assets,
                                   const scene::Vocabulary& vocabulary, int points);

}  // namespace simwright::pipeline
