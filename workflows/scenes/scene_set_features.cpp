#include "workflows/scenes/scene_set_features.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "core/image.h"
#include "core/parallel.h"
#include "scene/metrics/label_render.h"
#include "workflows/priors/models_folder.h"
#include "workflows/scenes/scene_feature_training.h"

namespace simwright::workflows {

std::optional<scene::SceneFeatures> ShippedSceneFeatures(core::Findings* findings) {
  const std::filesystem::path models = ModelsFolder();
  if (!models.empty() && std::filesystem::exists(FeatureWeights(models))) {
    return scene::SceneFeatures::Load(FeatureWeights(models));
  }
  findings->push_back({"features", core::Severity::kWarning, FeatureWeights(models).string(),
                       "no features were found: images are not compared (simwright scene "
                       "features trains them, --features uses your own network)",
                       0.0});
  return std::nullopt;
}

scene::FeatureMatrix FeaturesOfScenes(const std::vector<std::vector<scene::SceneObject>>& scenes,
                                      const scene::Vocabulary& vocabulary,
                                      const scene::AssetSet& asset_set,
                                      const scene::SceneFeatures& features,
                                      core::Progress* progress) {
  constexpr size_t kBatch = 64;  // images in memory at once
  const core::Camera camera = scene::LabelCamera(vocabulary.type);
  scene::FeatureMatrix matrix;
  for (size_t first = 0; first < scenes.size(); first += kBatch) {
    const size_t count = std::min(kBatch, scenes.size() - first);
    std::vector<core::Image> pictures(count);
    core::ParallelFor(static_cast<int>(count), [&](int i) {
      core::CheckCancelled();
      const auto at = static_cast<size_t>(i);
      pictures[at] =
          features.Resized(LabelRender(scenes[first + at], vocabulary, asset_set, camera));
      progress->Advance();
    });
    const scene::FeatureMatrix rows = features.Of(pictures);
    if (first == 0) matrix.resize(static_cast<Eigen::Index>(scenes.size()), rows.cols());
    if (rows.cols() != matrix.cols()) {
      throw core::Error("its number of features varies", features.name());
    }
    matrix.middleRows(static_cast<Eigen::Index>(first), rows.rows()) = rows;
  }
  return matrix;
}

}  // namespace simwright::workflows
