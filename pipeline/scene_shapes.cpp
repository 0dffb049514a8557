#include "pipeline/scene_shapes.h"

#include "assets/asset_folder.h"
#include "pipeline/dataset_scenes.h"

namespace simwright::pipeline {

std::vector<Eigen::Vector3d> ShapeOfAsset(const std::filesystem::path& folder, int points) {
  return scene::ShapeOf(assets::ReadAsset(folder).solid, points);
}

scene::AssetShapes ShapesOfDataset(const std::filesystem::path& path,
                                   const std::filesystem::path& assets,
                                   const scene::Vocabulary& vocabulary, int points) {
  const scene::SlotFolders folders =
      FoldersOfSlots(path, assets, {vocabulary.slots.begin(), vocabulary.slots.end()});
  scene::AssetShapes shapes;
  for (const std::string& slot : vocabulary.slots) {
    shapes.surfaces.push_back(ShapeOfAsset(folders.at(slot), points));
  }
  return shapes;
}

}  // namespace simwright::pipeline
