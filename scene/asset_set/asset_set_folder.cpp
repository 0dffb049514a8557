#include "scene/asset_set/asset_set_folder.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

// Returns the category of a folder name: "teapot" of "teapot_3", "apple_2" of "apple_2_3". The
// number at the end is the seed.
std::string CategoryOfName(const std::string& name) {
  size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1]))) --digits;
  const bool seeded = digits > 1 && digits < name.size() && name[digits - 1] == '_';
  return seeded ? name.substr(0, digits - 1) : name;
}

// Returns the rigid asset folders, sorted by name.
std::vector<fs::path> AssetFolders(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw core::Error("there is no folder of assets", folder.string(),
                      "make one with `simwright library`");
  }
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (assets::IsAssetFolder(path) && !assets::IsArticulatedAssetFolder(path)) {
      entries.push_back(path);
    }
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

AssetSet ReadAssetSet(const fs::path& folder) {
  CategoryFolders folders;
  for (const fs::path& path : AssetFolders(folder)) {
    folders.emplace(CategoryOfName(path.filename().string()),
                    path);  // keeps the first of a category
  }
  if (folders.empty()) throw core::Error("there are no rigid assets", folder.string());
  return ReadAssetSet(folders);
}

CategoryFolders FoldersForCategories(const fs::path& folder,
                                     const std::vector<std::string>& categories) {
  const std::set<std::string> wanted(categories.begin(), categories.end());
  CategoryFolders by_name, by_seed, by_category;
  for (const fs::path& path : AssetFolders(folder)) {
    const std::string name = path.filename().string();
    if (wanted.count(name) > 0) {
      by_name.emplace(name, path);
      continue;
    }
    const std::string named = CategoryOfName(name);
    if (wanted.count(named) > 0) by_seed.emplace(named, path);
    const std::string category = assets::ReadAsset(path).parameters.category;
    if (wanted.count(category) > 0) by_category.emplace(category, path);
  }
  by_name.merge(by_seed);
  by_name.merge(by_category);
  return by_name;
}

AssetSet ReadAssetSet(const CategoryFolders& folders) {
  AssetSet asset_set;
  for (const auto& [category, path] : folders) {
    const assets::Asset asset = assets::ReadAsset(path);
    if (asset.parts.empty()) {
      throw core::Error("the asset has no collision parts", path.string(),
                        "make it with `simwright import` or `lift`");
    }
    asset_set.Add(category, sim::BodyFromAsset(asset), asset.visual, path);
  }
  return asset_set;
}

}  // namespace simwright::scene
