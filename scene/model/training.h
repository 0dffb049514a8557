#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "nn/trainer_options.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/grammar/category_size.h"
#include "scene/model/asset_shapes.h"
#include "scene/model/loss_records.h"
#include "scene/model/model_options.h"

namespace simwright::scene {

struct SceneTrainingOptions {
  nn::TrainerOptions trainer;  // steps, learning rate, averaging, resuming
  // The batch size. Two cores have time for few steps, and four times as many steps of a quarter of
  // the size learn more than steps of 128 in the same time (docs/scenes.md); a GPU allows larger
  // batches.
  int batch = 32;
  // The held-out scenes at the end of the dataset: a share of all, and an upper bound on their
  // number.
  double held_out = 0.1;
  int held_out_most = 1000;
  int buffer = 16384;           // scenes held in memory (SceneStream)
  int report_every = 50;        // steps per line of the losses
  bool bfloat16_on_gpu = true;  // for matrix products; as in the paper
  // True: a thread makes the next batch while the network learns from the last one, with the same
  // numbers. None: with a GPU only; two cores are busy with the network (docs/scenes.md).
  std::optional<bool> prefetch = {};
  // True: an update takes each batch as a whole, and its losses stay on the device until they are
  // reported, so that nothing waits for it. None: with a GPU only.
  std::optional<bool> losses_on_device = {};
  // True: the kernels of an update are launched together as a CUDA graph, on a GPU where
  // nn::CapturedWork is available; elsewhere nothing changes. For models without prompts.
  bool cuda_graph = false;
  // True: noise is drawn on the network's device: faster on a GPU, with other numbers than a CPU's.
  bool noise_on_device = false;
  std::uint64_t seed = 1;
  AssetShapes shapes;  // of the dataset's categories, for a model with classes by shape
  // Options of a model that reads prompts: the share of scenes that train without one, the most
  // word pieces of its own encoder, the external encoder's file if it has one, and the sizes of the
  // categories, by which relations are recognised.
  double prompt_dropout = 0.1;
  int text_pieces = 512;
  std::filesystem::path text_encoder;
  CategorySizes sizes = DefaultCategorySizes();
  // Constructs the defaults. The paper's learning rate is 2e-4 for batches of 2048 over 200k steps;
  // with the few steps that two cores allow, a higher one learns more.
  SceneTrainingOptions();

  bool IsValid(std::string* error) const;
};

struct SceneTrainingReport {
  std::filesystem::path weights;
  std::int64_t parameters = 0;
  int training_scenes = 0, held_out_scenes = 0;
  double seconds = 0.0;            // of this run
  std::vector<LossRecord> losses;  // including earlier runs
};

// The files of a training folder.
inline constexpr char kWeightsFile[] = "model.pt", kStateFile[] = "training.pt",
                      kLossesFile[] = "losses.csv", kLossCurvesFile[] = "losses.svg";

// Trains a model on the scenes of datasets, one for each scene type. With several types, each
// update has as many scenes of one as of another, the types take turns, and each has its own number
// of entries and range of poses; such a model must read prompts, which name the type. At each saved
// state it writes the averaged weights to output/model.pt and the losses to output/losses.csv and
// output/losses.svg. Resumes from the state in `output` if the trainer's options ask for it. Throws
// core::Error for invalid options, for a damaged dataset, and if so many losses in a row are not
// finite that training has diverged; the last good state and weights are kept.
SceneTrainingReport TrainSceneModel(const std::vector<const SceneDataset*>& datasets,
                                    const SceneModelOptions& model,
                                    const SceneTrainingOptions& options,
                                    const std::filesystem::path& output, core::Progress* progress);
SceneTrainingReport TrainSceneModel(const SceneDataset& dataset, const SceneModelOptions& model,
                                    const SceneTrainingOptions& options,
                                    const std::filesystem::path& output, core::Progress* progress);

}  // namespace simwright::scene
