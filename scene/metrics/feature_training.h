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

// A label render and what is in it.
struct CountedPicture {
  core::Image picture;        // RGB, as the network takes it
  std::vector<float> counts;  // (kMostLabels x 5): in all, in the picture's quarters
};

// `camera`: that of the render, from which a thing's quarter is told, by its origin. What is
// outside the picture counts in no quarter. Throws as LabelRender does.
CountedPicture CountPicture(const std::vector<DrawnObject>& objects, const Vocabulary& vocabulary,
                            const Palette& palette, const core::Camera& camera);

struct FeatureTrainingOptions {
  nn::TrainerOptions trainer;
  int batch = 32;         // pictures of a step
  double held_out = 0.1;  // share of the pictures, the last, that are not learned from
  std::uint64_t seed = 1;
  FeatureTrainingOptions();

  bool IsValid(std::string* error) const;
};

struct FeatureTrainingReport {
  int pictures = 0, held_out = 0;
  std::int64_t parameters = 0;
  double seconds = 0.0;
  // Mean error of a class's count, of classes that held-out pictures have, objects; and that of
  // saying the mean of the training pictures.
  double error = 0.0, error_of_the_mean = 0.0;
};

// Trains the network of SceneFeatures to tell counts, pictures mirrored at random both ways, and
// writes its averaged weights to `weights`. Throws core::Error for options that are not valid or
// fewer than 10 pictures.
FeatureTrainingReport TrainFeatures(const std::vector<CountedPicture>& pictures,
                                    const FeatureTrainingOptions& options,
                                    const std::filesystem::path& weights, core::Progress* progress);

}  // namespace simwright::scene
