#include "workflows/scenes/dataset_scenes.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "assets/asset.h"
#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/json.h"
#include "scene/dataset/tokens.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

int SceneNumber(const std::string& text, const std::string& whole, int count) {
  int number = -1;
  const char* const end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data(), end, number);
  const bool is_number = !text.empty() && stop == end && text.front() != '-';
  if (!is_number || fault == std::errc::invalid_argument) {
    throw core::Error("this is not a list of scenes", whole, "as in 0,3-5");
  }
  if (fault != std::errc() || number >= count) {
    throw core::Error("there is no scene " + text + ", only 0 to " + std::to_string(count - 1),
                      whole);
  }
  return number;
}

}  // namespace

std::vector<int> ParseSceneIndices(const std::string& text, int count) {
  std::vector<int> scenes;
  std::set<int> known;
  std::istringstream list(text);
  for (std::string range; std::getline(list, range, ',');) {
    const size_t dash = range.find('-');
    const int first = SceneNumber(range.substr(0, dash), text, count);
    const int last =
        dash == std::string::npos ? first : SceneNumber(range.substr(dash + 1), text, count);
    if (last < first) throw core::Error("a range of scenes must ascend", range, "as in 0,3-5");
    for (int scene = first; scene <= last; ++scene) {
      if (known.insert(scene).second) scenes.push_back(scene);
    }
  }
  if (scenes.empty()) throw core::Error("no scene is named", text, "as in 0,3-5");
  return scenes;
}

std::vector<scene::SceneObject> SceneAt(const scene::SceneDataset& dataset, int index) {
  const std::vector<float> tokens = dataset.Read(index, 1);
  return DecodeScene(tokens.data(), dataset.vocabulary());
}

scene::CategoryFolders FoldersOfCategories(const fs::path& path, const fs::path& assets,
                                           const std::set<std::string>& categories) {
  const fs::path beside = fs::is_regular_file(path) ? path.parent_path() : path;
  const fs::path folder = assets.empty() ? beside / "assets" : assets;
  if (!fs::is_directory(folder)) {
    throw core::Error("there is no folder of assets", folder.string(),
                      "give the one the scenes were made with: --assets FOLDER");
  }
  scene::CategoryFolders folders;
  for (const std::string& category : categories) {
    if (assets::FileSafeName(category) != category) {
      throw core::Error("a category of the scenes is not a valid folder name", category);
    }
    if (!assets::IsAssetFolder(folder / category)) {
      throw core::Error("there is no asset for the category \"" + category + "\"", folder.string());
    }
    folders[category] = folder / category;
  }
  return folders;
}

void RequireSameAssets(const scene::SceneDataset& dataset, const scene::AssetSet& asset_set,
                       const std::set<std::string>& categories) {
  const std::string& text = dataset.parts().front().origin().assets;
  const auto hashes = core::TryParseJson(text);
  if (!hashes) return;
  for (const std::string& category : categories) {
    const core::Json* hash = core::FindMember(*hashes, category.c_str());
    if (hash == nullptr || !hash->is_string()) continue;
    if (hash->get<std::string>() != asset_set.HashOf(category)) {
      throw core::Error("the asset for the category \"" + category +
                        "\" is not the one the scenes were made with");
    }
  }
}

}  // namespace simwright::workflows
