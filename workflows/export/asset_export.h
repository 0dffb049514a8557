#pragma once

#include <filesystem>
#include <string>

#include "core/finding.h"

namespace simwright::workflows {

enum class AssetFormat { kUsd, kGlb };

struct AssetExportRequest {
  std::filesystem::path asset;   // the folder of a rigid or an articulated asset
  std::filesystem::path output;  // a folder; kGlb: a file
  bool force = false;            // replaces an existing folder or file
  AssetFormat format = AssetFormat::kUsd;
};

struct AssetExportReport {
  std::filesystem::path output;  // the folder
  std::string file;              // the layer or GLB, in `output`: "mug.usda"
  int bodies = 0;
  int joints = 0;     // that move
  int shapes = 0;     // that collide
  int textures = 0;   // files
  double mass = 0.0;  // kg, of all bodies
  core::Findings findings;
};

// Writes an asset as OpenUSD (assets::UsdOf): NAME.usda, and its images in textures/; or its
// visuals as one GLB (assets::GlbText). Throws core::Error if the folder holds no asset, the output
// exists, or the GLB's name has another extension.
AssetExportReport ExportAsset(const AssetExportRequest& request);

std::string AssetExportTable(const AssetExportReport& report);
std::string AssetExportJson(const AssetExportReport& report);

}  // namespace simwright::workflows
