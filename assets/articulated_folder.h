#pragma once

#include <filesystem>

#include "assets/articulated_asset.h"

namespace simwright::assets {

// Writes every file of the asset but preview.png (whoever draws it adds it) into `folder`, which
// exists: meshes, URDF, MJCF, semantics.txt, asset.json (docs/formats.md). The same asset gives
// the same bytes. Throws core::Error when something cannot be written.
void WriteArticulatedAsset(const ArticulatedAsset& asset, const std::filesystem::path& folder);

// Reads a folder back from asset.json and its meshes. Throws core::Error when asset.json is
// missing, malformed, of a newer format, of a rigid asset, or names a missing mesh.
ArticulatedAsset ReadArticulatedAsset(const std::filesystem::path& folder);

// True where the folder holds an asset.json that says `articulated: true`.
bool IsArticulatedAssetFolder(const std::filesystem::path& folder);

}  // namespace simwright::assets
