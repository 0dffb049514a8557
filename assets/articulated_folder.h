#pragma once

#include <filesystem>

#include "assets/articulated_asset.h"

namespace simwright::assets {

// Writes all files of the asset except preview.png (its renderer adds it) into the existing
// `folder`: meshes, URDF, MJCF, semantics.txt, asset.json (docs/formats.md). The same asset gives
// the same bytes. Throws core::Error when something cannot be written.
void WriteArticulatedAsset(const ArticulatedAsset& asset, const std::filesystem::path& folder);

// Reads an asset from a folder's asset.json and its meshes. Throws core::Error if asset.json is
// missing, malformed, of a newer format, of a rigid asset, or names a missing mesh.
ArticulatedAsset ReadArticulatedAsset(const std::filesystem::path& folder);

// Returns true if the folder holds an asset.json with `articulated: true`.
bool IsArticulatedAssetFolder(const std::filesystem::path& folder);

}  // namespace simwright::assets
