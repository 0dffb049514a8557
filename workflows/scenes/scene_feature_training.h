#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/metrics/feature_training.h"

namespace simwright::workflows {

struct SceneFeatureTrainingRequest {
  std::vector<std::filesystem::path> datasets;  // written by `scene generate`
  // Scene types whose grammars contribute additional samples, without physics. If it and `datasets`
  // are both empty, all types are used.
  std::vector<std::string> types;
  int samples = 300;                          // samples per type
  std::vector<std::filesystem::path> assets;  // searched in this order, then the library
  std::filesystem::path weights;              // the output file
  scene::FeatureTrainingOptions options;
};

// Trains the network whose features `scene evaluate` uses to compare images. It learns to predict
// object counts in label renders of scenes; each scene is rendered twice: unchanged, and with
// random objects removed and displaced, as poor models produce them. Throws core::Error for an
// unknown type, a damaged dataset, or fewer than 10 scenes.
scene::FeatureTrainingReport TrainSceneFeatures(const SceneFeatureTrainingRequest& request,
                                                core::Progress* progress);

// Returns the path of the shipped feature weights in a folder of models.
std::filesystem::path FeatureWeights(const std::filesystem::path& models);

}  // namespace simwright::workflows
