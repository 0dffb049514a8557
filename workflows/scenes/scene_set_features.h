#pragma once

#include <optional>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/asset_set/asset_set.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"
#include "scene/metrics/feature_matrix.h"
#include "scene/metrics/scene_features.h"

namespace simwright::workflows {

// The learning rate of scene::ClassifierAccuracy on our few features.
inline constexpr double kOwnFeaturesRate = 1e-2;

// Returns Simwright's own features of label renders; without their weights nothing, and a warning.
std::optional<scene::SceneFeatures> ShippedSceneFeatures(core::Findings* findings);

// Returns the features of the label renders of scenes, a row each. Advances `progress` by one per
// scene. Throws core::Error as scene::LabelRender and scene::SceneFeatures do.
scene::FeatureMatrix FeaturesOfScenes(const std::vector<std::vector<scene::SceneObject>>& scenes,
                                      const scene::Vocabulary& vocabulary,
                                      const scene::AssetSet& asset_set,
                                      const scene::SceneFeatures& features,
                                      core::Progress* progress);

}  // namespace simwright::workflows
