#pragma once

#include <filesystem>
#include <string>

#include "scene/asset_set/asset_set_folder.h"
#include "steering/search/token_scene.h"

namespace simwright::workflows {

// A scene that a search starts from.
struct StartScene {
  steering::TokenScene scene;      // without flags
  scene::CategoryFolders folders;  // the assets of its categories
  std::filesystem::path assets;    // its folder of asset folders; empty: none
};

// Reads a scene in any form that ReadSceneSource takes, of a dataset scene `index` (empty: the
// first). Throws core::Error, naming the object, for more objects than the model's entries, an
// asset that the model does not know, two assets of one category, or as ReadSceneSource does.
StartScene ReadStartScene(const std::filesystem::path& path, const std::string& index,
                          const std::filesystem::path& assets, const scene::Vocabulary& vocabulary);

}  // namespace simwright::workflows
