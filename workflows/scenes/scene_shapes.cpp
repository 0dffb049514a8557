#include "workflows/scenes/scene_shapes.h"

#include "assets/asset_folder.h"
#include "workflows/scenes/dataset_scenes.h"

namespace simwright::workflows {

std::vector<Eigen::Vector3d> ShapeOfAsset(const std::filesystem::path& folder, int points) {
  return scene::ShapeOf(assets::ReadAsset(folder).solid, points);
}

scene::AssetShapes ShapesOfDataset(const std::filesystem::path& path,
                                   const std::filesystem::path& assets,
                                   const scene::Vocabulary& vocabulary, int points) {
  const scene::CategoryFolders folders = FoldersOfCategories(
      path, assets, {vocabulary.categories.begin(), vocabulary.categories.end()});
  scene::AssetShapes shapes;
  for (const std::string& category : vocabulary.categories) {
    shapes.surfaces.push_back(ShapeOfAsset(folders.at(category), points));
  }
  return shapes;
}

scene::CategorySizes SizesOfDataset(const std::filesystem::path& path,
                                    const std::filesystem::path& assets,
                                    const scene::Vocabulary& vocabulary) {
  const bool is_file = std::filesystem::is_regular_file(path);
  const std::filesystem::path beside = (is_file ? path.parent_path() : path) / "assets";
  const std::filesystem::path& folder = assets.empty() ? beside : assets;
  if (!std::filesystem::is_directory(folder)) return scene::DefaultCategorySizes();
  const scene::CategoryFolders folders = scene::FoldersForCategories(folder, vocabulary.categories);
  if (folders.empty()) return scene::DefaultCategorySizes();
  return scene::ReadAssetSet(folders).Sizes();
}

}  // namespace simwright::workflows
