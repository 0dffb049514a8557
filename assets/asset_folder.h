#pragma once

#include <filesystem>

#include "assets/asset.h"

namespace simwright::assets {

// Writes all files of the asset except preview.png (its renderer adds it) into the existing
// `folder`: meshes, URDF, MJCF, SDF, asset.json (docs/formats.md). The same asset gives the same
// bytes. Throws core::Error when something cannot be written.
void WriteAsset(const Asset& asset, const std::filesystem::path& folder);

// Reads an asset from a folder's asset.json and its meshes. Throws core::Error if asset.json is
// missing, malformed, of a newer format, or names a missing mesh.
Asset ReadAsset(const std::filesystem::path& folder);

// Adds findings to the asset.json of a rigid or an articulated asset's folder, unless they are
// there already; other files and values are unchanged. Throws core::Error if it cannot be read or
// written.
void AddFindings(const std::filesystem::path& folder, const core::Findings& findings);

// Returns true if the folder holds an asset.json.
bool IsAssetFolder(const std::filesystem::path& folder);

}  // namespace simwright::assets
