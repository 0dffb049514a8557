#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/palette_folder.h"

namespace simwright::pipeline {

// What stands in scenes for their slots.
struct SceneAssetsRequest {
  std::vector<std::string> slots;              // all that are wanted
  scene::SlotFolders chosen;                   // these come first
  std::vector<std::filesystem::path> folders;  // then what is in these, in their order
  // Where all of them are kept, each in a folder of its slot's name. What is here already stays,
  // unless something else is chosen for it.
  std::filesystem::path kept;
  // Gets a note of what is taken of each of `folders`, and a warning for one of which nothing is:
  // "assets-unused". May be null.
  core::Findings* findings = nullptr;
};

// Makes what is asked for be in `kept`: copies what is chosen or found, and makes of the library
// what is left; "apple_2" is an apple of seed 2. Workers that share the folder wait for each other.
// Throws core::Error where a chosen folder is no asset, where a slot has another asset already, and
// where the library has no such kind or its asset fails the check.
scene::SlotFolders GatherSceneAssets(const SceneAssetsRequest& request, core::Progress* progress);

}  // namespace simwright::pipeline
