#include "workflows/scenes/before_after.h"

#include <algorithm>

#include "core/image.h"
#include "core/parallel.h"
#include "scene/export/scene_picture.h"

namespace simwright::workflows {
namespace {

constexpr size_t kPairs = 6, kSheetScenes = 12;
constexpr int kSheetColumns = 4, kPairSize = 320;  // pixels per side
constexpr int kSamplesPerSide = 2;                 // half the time of three, and hardly coarser

// A picture to be rendered: a scene, by a camera that shows the whole pair.
struct View {
  const std::vector<scene::SceneObject>* objects;
  const ScenePair* pair;
  bool above;
};

std::vector<core::Image> RenderViews(const std::vector<View>& views,
                                     const scene::AssetSet& asset_set) {
  std::vector<core::Image> pictures(views.size());
  core::ParallelFor(static_cast<int>(views.size()), [&](int i) {
    const View& view = views[static_cast<size_t>(i)];
    std::vector<scene::SceneObject> both = view.pair->before;
    both.insert(both.end(), view.pair->after.begin(), view.pair->after.end());
    const core::Camera camera = view.above ? AboveCamera(both, asset_set, kPairSize)
                                           : SideCamera(both, asset_set, kPairSize);
    pictures[static_cast<size_t>(i)] =
        RenderScene(*view.objects, asset_set, camera, kSamplesPerSide);
  });
  return pictures;
}

}  // namespace

void WriteBeforeAfter(const std::vector<ScenePair>& pairs, const scene::AssetSet& asset_set,
                      const std::filesystem::path& folder) {
  if (pairs.empty()) return;
  const size_t after = std::min(kSheetScenes, pairs.size());
  const size_t before = std::min(kPairs, pairs.size());
  std::vector<View> views;
  for (size_t i = 0; i < after; ++i) views.push_back({&pairs[i].after, &pairs[i], false});
  for (size_t i = 0; i < before; ++i) views.push_back({&pairs[i].before, &pairs[i], false});
  if (pairs.size() == 1) {
    views.push_back({&pairs[0].before, &pairs[0], true});
    views.push_back({&pairs[0].after, &pairs[0], true});
  }
  const std::vector<core::Image> pictures = RenderViews(views, asset_set);
  std::vector<core::Image> sheet;
  for (size_t i = 0; i < before; ++i) {
    sheet.push_back(pictures[after + i]);
    sheet.push_back(pictures[i]);
  }
  sheet.insert(sheet.end(), pictures.begin() + static_cast<std::ptrdiff_t>(after + before),
               pictures.end());
  core::WritePng(folder / "before_after.png", core::ContactSheet(sheet, 2));
  const auto end = pictures.begin() + static_cast<std::ptrdiff_t>(after);
  core::WritePng(folder / "scenes.png", core::ContactSheet({pictures.begin(), end}, kSheetColumns));
}

}  // namespace simwright::workflows
