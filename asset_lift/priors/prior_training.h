#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "core/random.h"
#include "nn/trainer_options.h"

namespace simwright::asset_lift {

// Returns a random mesh (any units, z up); called from several threads.
using TrainingMeshSampler = std::function<core::TexturedMesh(core::Rng* rng)>;

struct PriorTrainingOptions {
  nn::TrainerOptions trainer;
  int batch = 16;  // photos per step
  // For the shape network: the photos of a step that are newly rendered (0: all); the step draws
  // its `batch` from the `memory` last ones (some 300 KB each). Rendering takes longer than a GPU's
  // step.
  int fresh = 0;
  int memory = 0;
  // The number of objects kept ready for rendering. Each step renders photos of random ones and
  // replaces the `exchange` oldest.
  int pool = 160;
  int exchange = 1;
  // The share of parametric shapes among the objects, in [0, 1], and that of meshes of `sampler`
  // (none without one); the others are randomly stretched meshes of the catalogue.
  double parametric_share = 0.4;
  TrainingMeshSampler sampler;
  double sampler_share = 0.25;
  // The channels of the shape network's levels, each at half the resolution of the one before: one
  // to six multiples of 8. The weights' file keeps them.
  std::vector<int> shape_channels = {48, 96, 192, 256};
  std::uint64_t seed = 1;
  // The file of initial weights of the same network; empty: random initialization.
  std::filesystem::path start;

  // Returns false for invalid values, with the reason in `error` unless it is null.
  bool IsValid(std::string* error) const;
};

// The progress of a training; loss and metrics are means over the steps since the previous report.
struct PriorTrainingReport {
  int step = 0;  // number of completed steps
  double loss = 0.0;
  std::vector<std::pair<std::string, double>> metrics;  // name with unit, value
  double seconds = 0.0;                                 // since this run started or resumed
};
using PriorTrainingListener = std::function<void(const PriorTrainingReport&)>;

// Both functions train on random photos of `meshes` (any units; may be empty) and of parametric
// shapes. They write the averaged weights to the file `weights` every `trainer.save_every` steps,
// report every 50 steps, and return the last report. They throw core::Error for invalid options and
// for weights that cannot be read or written, and core::Cancelled after Ctrl-C; `trainer.resume`
// continues a cancelled training.

// Trains the shape prior's network. The metrics are the IoU of the predicted volume, in which cells
// of a probability above 0.5 are filled, and the mean absolute error of the camera's elevation, in
// degrees.
PriorTrainingReport TrainShapeNetwork(const std::vector<core::TexturedMesh>& meshes,
                                      const PriorTrainingOptions& options,
                                      const std::filesystem::path& weights,
                                      core::Progress* progress,
                                      const PriorTrainingListener& report = {});

// Trains the view prior's network, whose inputs include renderings of the shape prior in
// `shape_weights`. The loss is the mean squared error of the predicted noise. The first metric is
// the mean squared error of the predicted clean image, with the error scaled by the schedule's
// signal coefficient; the second is the same error for the shape prior's rendering in place of the
// predicted image.
PriorTrainingReport TrainViewNetwork(const std::vector<core::TexturedMesh>& meshes,
                                     const std::filesystem::path& shape_weights,
                                     const PriorTrainingOptions& options,
                                     const std::filesystem::path& weights, core::Progress* progress,
                                     const PriorTrainingListener& report = {});

}  // namespace simwright::asset_lift
