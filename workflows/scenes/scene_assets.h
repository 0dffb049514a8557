#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/asset_set/asset_set_folder.h"

namespace simwright::workflows {

// The request for the assets of scene categories.
struct SceneAssetsRequest {
  std::vector<std::string> categories;         // all required categories
  scene::CategoryFolders chosen;               // takes precedence
  std::vector<std::filesystem::path> folders;  // searched next, in this order
  // The folder that keeps all assets, each in a folder named after its category. Existing ones are
  // kept unless `chosen` names another one.
  std::filesystem::path kept;
  // Receives a note for each of `folders` that lists the assets used, and a warning,
  // "assets-unused", for a folder of which none is used. May be null.
  core::Findings* findings = nullptr;
};

// Provides the requested assets in `kept`: copies the chosen or found ones and makes the rest from
// the library; "apple_2" is an apple of seed 2. Workers that share the folder wait for each other.
// Throws core::Error if a chosen folder is not an asset, if a category already has another asset,
// or if the library has no such kind or its asset fails the check.
scene::CategoryFolders GatherSceneAssets(const SceneAssetsRequest& request,
                                         core::Progress* progress);

}  // namespace simwright::workflows
