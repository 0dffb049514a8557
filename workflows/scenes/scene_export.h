#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "workflows/scenes/scene_stability.h"

namespace simwright::workflows {

struct SceneExportRequest {
  std::filesystem::path dataset;  // a folder of shards, or one shard
  std::string scenes;             // "0,3-5"; empty: the first `count`
  int count = -1;                 // -1: all scenes
  std::set<std::string> formats;  // from SceneFormats(), or "all"
  std::filesystem::path output;
  std::filesystem::path assets;  // a folder of SLOT folders; empty: the dataset's own
  bool check = false;            // checks each scene's stability in both engines; also writes MJCF
  bool force = false;            // replaces an existing output
};

struct SceneExportReport {
  std::filesystem::path output;
  std::vector<std::string> scenes;  // their folder names
  int assets = 0;
  std::vector<SceneStability> checks;  // one per scene, if requested

  // Returns the fraction of the checked scenes that are statically stable, in [0, 1]; 1 if none was
  // checked.
  double StableFraction() const;
};

// Returns the names of the formats: urdf, sdf, mjcf, drake, usd.
const std::vector<std::string>& SceneFormats();

// Writes scenes as world files (docs/formats.md): one folder per scene, and each category's asset
// once in output/assets. Throws core::Error before writing anything for an unknown format or scene,
// for assets that are missing or differ from those of the scenes, and for an existing output.
SceneExportReport ExportScenes(const SceneExportRequest& request, core::Progress* progress);

// Renders a scene from above and from a side, next to each other, each `size` pixels a side. Throws
// core::Error as ExportScenes does.
core::Image SceneView(const std::filesystem::path& dataset, const std::filesystem::path& assets,
                      int scene, int size);

// Format the report as text for people and as JSON.
std::string ExportTable(const SceneExportReport& report);
std::string ExportJson(const SceneExportReport& report);
// Formats only the check results as JSON: the same scenes give the same bytes.
std::string StabilityJson(const SceneExportReport& report);

}  // namespace simwright::workflows
