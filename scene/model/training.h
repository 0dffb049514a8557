#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "nn/trainer_options.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/model/asset_shapes.h"
#include "scene/model/loss_records.h"
#include "scene/model/model_options.h"

namespace simwright::scene {

struct SceneTrainingOptions {
  nn::TrainerOptions trainer;  // the steps, their rate, averaging, resuming
  // Scenes of a step. Two cores have time for few steps, and four times as many of a quarter learn
  // more than fewer of 128 do in the same time (docs/scenes.md); a GPU has room for more.
  int batch = 32;
  // Scenes at the dataset's end that training does not see: a share of all, but no more than so
  // many.
  double held_out = 0.1;
  int held_out_most = 1000;
  int buffer = 16384;           // scenes held in memory (SceneStream)
  int report_every = 50;        // steps between two lines of the losses
  bool bfloat16_on_gpu = true;  // products of matrices; as the paper trains
  std::uint64_t seed = 1;
  AssetShapes shapes;  // of the dataset's slots, for a model that knows classes by them
  // The paper's rate is 2e-4 for batches of 2048 over 200k steps; of the few steps that two cores
  // have, a higher one learns more.
  SceneTrainingOptions();

  bool IsValid(std::string* error) const;
};

struct SceneTrainingReport {
  std::filesystem::path weights;
  std::int64_t parameters = 0;
  int training_scenes = 0, held_out_scenes = 0;
  double seconds = 0.0;            // of this run
  std::vector<LossRecord> losses;  // earlier runs' included
};

// Files of a training's folder.
inline constexpr char kWeightsFile[] = "model.pt", kStateFile[] = "training.pt",
                      kLossesFile[] = "losses.csv", kLossCurvesFile[] = "losses.svg";

// Trains a model on the scenes of a dataset and writes it, the averaged weights, to
// output/model.pt, at each state that is saved; the losses go to output/losses.csv and, as a
// picture, losses.svg. Goes on from
// the state in `output` where the trainer's options say so. Throws core::Error for options that are
// not valid, a damaged dataset, and where the loss is not finite so often that the training has
// diverged: then the last good state and weights stay.
SceneTrainingReport TrainSceneModel(const SceneDataset& dataset, const SceneModelOptions& model,
                                    const SceneTrainingOptions& options,
                                    const std::filesystem::path& output, core::Progress* progress);

}  // namespace simwright::scene
