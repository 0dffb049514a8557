#include "workflows/scenes/search_pictures.h"

#include <algorithm>

#include "core/image.h"
#include "core/parallel.h"
#include "scene/export/scene_picture.h"

namespace simwright::workflows {

void WriteBestPath(const steering::SceneSearch& search, const scene::Vocabulary& vocabulary,
                   const scene::AssetSet& asset_set, const std::filesystem::path& path) {
  constexpr size_t kMostPictures = 12;
  constexpr int kColumns = 4, kSize = 320, kSamplesPerPixelSide = 2;
  const std::vector<int> nodes = search.tree().PathTo(search.best());
  const size_t count = std::min(kMostPictures, nodes.size());
  std::vector<std::vector<scene::SceneObject>> scenes;
  std::vector<scene::SceneObject> all;  // for a camera that shows every scene
  for (size_t i = 0; i < count; ++i) {
    const size_t at = count == 1 ? nodes.size() - 1 : i * (nodes.size() - 1) / (count - 1);
    const auto node = static_cast<size_t>(nodes[at]);
    scenes.push_back(search.scenes()[node].Judged(vocabulary).objects);
    all.insert(all.end(), scenes.back().begin(), scenes.back().end());
  }
  if (all.empty()) return;
  const core::Camera camera = SideCamera(all, asset_set, kSize);
  std::vector<core::Image> pictures(count);
  core::ParallelFor(static_cast<int>(count), [&](int i) {
    const auto index = static_cast<size_t>(i);
    if (scenes[index].empty()) scenes[index] = all;  // an empty scene cannot be rendered
    pictures[index] = RenderScene(scenes[index], asset_set, camera, kSamplesPerPixelSide);
  });
  core::WritePng(path, core::ContactSheet(pictures, kColumns));
}

}  // namespace simwright::workflows
