#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "pipeline/scene_stillness.h"

namespace simwright::pipeline {

struct SceneExportRequest {
  std::filesystem::path dataset;  // folder of parts, or one part
  std::string scenes;             // "0,3-5"; empty: the first `count`
  int count = -1;                 // -1: all there are
  std::set<std::string> formats;  // of SceneFormats(), or "all"
  std::filesystem::path output;
  std::filesystem::path assets;  // folder of SLOT folders; empty: the dataset's own
  bool check = false;            // watch each scene in both engines; MJCF is written then too
  bool force = false;            // replace an output that exists
};

struct SceneExportReport {
  std::filesystem::path output;
  std::vector<std::string> scenes;  // names of their folders
  int assets = 0;
  std::vector<SceneStillness> checks;  // of each scene, where they were asked for

  // Of the scenes that were watched, those that stand still, in [0, 1]; 1 without any.
  double StillShare() const;
};

// urdf, sdf, mjcf, drake.
const std::vector<std::string>& SceneFormats();

// Writes scenes as world files (docs/formats.md): a folder for each, and the assets of their slots
// once, in output/assets. Throws core::Error before anything is written for a format or scene that
// there is not, assets that are missing or are not those of the scenes, and an output that exists.
SceneExportReport ExportScenes(const SceneExportRequest& request, core::Progress* progress);

// A scene from above and from a side, beside each other; `size`: pixels a side of each. Throws
// core::Error as ExportScenes does.
core::Image SceneView(const std::filesystem::path& dataset, const std::filesystem::path& assets,
                      int scene, int size);

// As text for people, and as JSON.
std::string ExportTable(const SceneExportReport& report);
std::string ExportJson(const SceneExportReport& report);
// What the checks found alone: the same scenes, the same bytes.
std::string StillnessJson(const SceneExportReport& report);

}  // namespace simwright::pipeline
