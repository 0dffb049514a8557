#pragma once

#include <filesystem>
#include <string>

#include "core/finding.h"

namespace simwright::workflows {

struct AssetExportRequest {
  std::filesystem::path asset;   // the folder of a rigid or an articulated asset
  std::filesystem::path output;  // a folder
  bool force = false;            // replaces an existing folder
};

struct AssetExportReport {
  std::filesystem::path output;
  std::string file;  // the layer, in `output`: "mug.usda"
  int bodies = 0;
  int joints = 0;     // that move
  int shapes = 0;     // that collide
  int textures = 0;   // files
  double mass = 0.0;  // kg, of all bodies
  core::Findings findings;
};

// Writes an asset as OpenUSD (assets::UsdOf): NAME.usda, and its images in textures/. Throws
// core::Error if the folder holds no asset, or the output exists.
AssetExportReport ExportAsset(const AssetExportRequest& request);

std::string AssetExportTable(const AssetExportReport& report);
std::string AssetExportJson(const AssetExportReport& report);

}  // namespace simwright::workflows
