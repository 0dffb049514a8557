#pragma once

#include <filesystem>
#include <memory>

#include "core/json.h"
#include "viewer/content.h"

namespace simwright::viewer {

// Returns the model of an asset folder of ours (with the grasps of its grasps.json), of a folder
// with a URDF, of a URDF, or of a mesh file. Throws core::Error if it cannot be read; grasps that
// cannot be read are a finding.
core::OrderedJson ModelOfPath(const std::filesystem::path& path, DocumentBuilder* builder);

// Returns the content of one asset, as ModelOfPath reads it. A rigid asset can be dropped.
std::unique_ptr<Content> ReadAssetView(const std::filesystem::path& path);

// Returns the content of a folder of asset folders, one entry each. Damaged assets are findings.
// Throws core::Error if all are damaged.
std::unique_ptr<Content> ReadAssetsView(const std::filesystem::path& folder);

}  // namespace simwright::viewer
