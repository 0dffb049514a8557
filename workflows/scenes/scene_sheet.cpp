#include "workflows/scenes/scene_sheet.h"

#include <algorithm>

#include "core/image.h"
#include "scene/dataset/tokens.h"
#include "scene/export/scene_picture.h"

namespace simwright::workflows {

void WriteSceneSheet(const scene::SceneDataset& dataset, const scene::AssetSet& asset_set,
                     const std::filesystem::path& path) {
  constexpr int kScenes = 12, kSize = 420;  // pixels per side
  const int count = std::min(kScenes, dataset.SceneCount());
  if (count == 0) return;
  std::vector<core::Image> pictures;
  for (const auto& objects : DecodeScenes(dataset.Read(0, count), dataset.vocabulary())) {
    if (!objects.empty()) pictures.push_back(RenderFromSide(objects, asset_set, kSize));
  }
  if (!pictures.empty()) core::WritePng(path, core::ContactSheet(pictures, 4));
}

}  // namespace simwright::workflows
