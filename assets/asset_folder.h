#pragma once

#include <filesystem>

#include "assets/asset.h"

namespace simwright::assets {

// Writes every file of the asset but preview.png (whoever draws it adds it) into `folder`, which
// exists: meshes, URDF, MJCF, SDF, asset.json (docs/formats.md). The same asset gives the same
// bytes. Throws core::Error when something cannot be written.
void WriteAsset(const Asset& asset, const std::filesystem::path& folder);

// Reads a folder back from asset.json and its meshes. Throws core::Error when asset.json is
// missing, malformed, of a newer format, or names a missing mesh.
Asset ReadAsset(const std::filesystem::path& folder);

// Adds to the findings in the asset.json of a rigid or an articulated asset's folder those
// that are not there yet; the other files and values stay as they are. Throws core::Error where it cannot be read or written.
void AddFindings(const std::filesystem::path& folder, const core::Findings& findings);

// True where the folder holds an asset.json.
bool IsAssetFolder(const std::filesystem::path& folder);

}  // namespace simwright::assets
