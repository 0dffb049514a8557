#include "twin/table_assets.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/error.h"

namespace simwright::twin {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostTableAssets = 200;
constexpr double kShortestAsset = 0.01, kLongestAsset = 0.8;  // m, of the longest side

// Returns the asset folders that a path means.
std::vector<fs::path> AssetFoldersOf(const fs::path& path) {
  if (!fs::is_directory(path)) throw core::Error("no such folder of assets", path.string());
  if (assets::IsAssetFolder(path)) return {path};
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    if (entry.is_directory() && assets::IsAssetFolder(entry.path())) {
      folders.push_back(entry.path());
    }
  }
  if (folders.empty()) {
    throw core::Error("the folder holds no asset", path.string(),
                      "name folders that simwright import, lift or library wrote");
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

TableAsset ReadTableAsset(const fs::path& folder) {
  TableAsset table_asset;
  table_asset.folder = folder;
  table_asset.name = assets::FileSafeName(fs::weakly_canonical(folder).filename().string());
  table_asset.articulated = assets::IsArticulatedAssetFolder(folder);
  if (table_asset.articulated) {
    const assets::ArticulatedAsset asset = assets::ReadArticulatedAsset(folder);
    if (assets::IsRobot(asset)) throw core::Error("it is a robot");
    table_asset.visual = assets::VisualAtPositions(asset);
    table_asset.category = asset.parameters.category;
  } else {
    assets::Asset asset = assets::ReadAsset(folder);
    table_asset.visual = std::move(asset.visual);
    table_asset.category = asset.parameters.category;
  }
  const Eigen::AlignedBox3d box = core::Bounds(table_asset.visual.mesh);
  if (box.isEmpty() || table_asset.visual.mesh.empty()) throw core::Error("it has no surface");
  table_asset.size = box.sizes();
  const double longest = table_asset.size.maxCoeff();
  if (longest < kShortestAsset || longest > kLongestAsset) {
    throw core::Error("it is shorter than 1 cm or longer than 80 cm");
  }
  return table_asset;
}

}  // namespace

std::vector<TableAsset> ReadTableAssets(const std::vector<fs::path>& folders,
                                        core::Findings* findings) {
  std::vector<fs::path> all;
  for (const fs::path& folder : folders) {
    const std::vector<fs::path> below = AssetFoldersOf(folder);
    all.insert(all.end(), below.begin(), below.end());
  }
  if (all.size() > kMostTableAssets) {
    throw core::Error("more than 200 assets are given", std::to_string(all.size()),
                      "name the folders of those that may be on the table");
  }
  std::vector<TableAsset> read;
  for (const fs::path& folder : all) {
    try {
      read.push_back(ReadTableAsset(folder));
    } catch (const core::Error& error) {
      findings->push_back({"twin-asset-unused", core::Severity::kWarning,
                           folder.filename().string(),
                           std::string("the asset is not looked for: ") + error.what()});
    }
  }
  return read;
}

}  // namespace simwright::twin
