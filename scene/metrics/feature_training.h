#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/progress.h"
#include "nn/trainer_options.h"
#include "scene/metrics/label_render.h"

namespace simwright::scene {

// A label render and its object counts.
struct CountedPicture {
  core::Image picture;        // RGB, of the network's input size
  std::vector<float> counts;  // (kMaxLabels x 5): total, then per image quadrant
};

// Renders and counts a scene. `camera`: the camera of the render; an object's quadrant is that of
// its projected origin. Objects outside the image count in no quadrant. Throws as LabelRender does.
CountedPicture CountPicture(const std::vector<SceneObject>& objects, const Vocabulary& vocabulary,
                            const AssetSet& asset_set, const core::Camera& camera);

struct FeatureTrainingOptions {
  nn::TrainerOptions trainer;
  int batch = 32;         // images per step
  double held_out = 0.1;  // share of the images, the last ones, excluded from training
  std::uint64_t seed = 1;
  FeatureTrainingOptions();

  bool IsValid(std::string* error) const;
};

struct FeatureTrainingReport {
  int pictures = 0, held_out = 0;
  std::int64_t parameters = 0;
  double seconds = 0.0;
  // The mean error of the class counts, over the classes that occur in held-out images, in objects;
  // and the error of a constant prediction of the training mean.
  double error = 0.0, error_of_the_mean = 0.0;
};

// Trains the network of SceneFeatures to predict counts, on images mirrored at random in both
// directions, and writes its averaged weights to `weights`. Throws core::Error for invalid options
// or fewer than 10 images.
FeatureTrainingReport TrainFeatures(const std::vector<CountedPicture>& pictures,
                                    const FeatureTrainingOptions& options,
                                    const std::filesystem::path& weights, core::Progress* progress);

}  // namespace simwright::scene
