#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/metrics/feature_training.h"

namespace simwright::pipeline {

struct SceneFeatureTrainingRequest {
  std::vector<std::filesystem::path> datasets;  // what `scene generate` wrote
  // Scenes drawn from the grammar of each type besides, without physics. Empty with no datasets:
  // all types.
  std::vector<std::string> types;
  int draws = 300;                            // of each type
  std::vector<std::filesystem::path> assets;  // folders, the first first; the library for the rest
  std::filesystem::path weights;              // to be written
  scene::FeatureTrainingOptions options;
};

// Trains the network by whose features `scene evaluate` compares pictures: to tell counts in label
// renders of scenes, two renders each: as it is, and with objects left out and moved at random, as
// poor models have them. Throws core::Error for an unknown type, a damaged dataset, or fewer than
// 10 scenes.
scene::FeatureTrainingReport TrainSceneFeatures(const SceneFeatureTrainingRequest& request,
                                                core::Progress* progress);

// The shipped features' weights in a folder of models.
std::filesystem::path FeatureWeights(const std::filesystem::path& models);

}  // namespace simwright::pipeline
