#pragma once

#include <filesystem>

#include "asset_build/asset_builder.h"
#include "assets/asset.h"

namespace simwright::workflows {

// An imported mesh before and after.
struct ImportReport {
  const core::TexturedMesh& as_read;  // as the file has it, z up
  const assets::Asset& asset;
  const asset_build::StageSeconds& seconds;
};

// Writes into `folder`: import.html (what was found and done, the numbers of the file's mesh, the
// visual mesh and the solid beside each other, and pictures of them) and its pictures before.png
// and after.png.
void WriteImportReport(const ImportReport& report, const std::filesystem::path& folder);

}  // namespace simwright::workflows
