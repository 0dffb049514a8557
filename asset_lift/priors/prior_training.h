#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "nn/trainer_options.h"

namespace simwright::asset_lift {

struct PriorTrainingOptions {
  nn::TrainerOptions trainer;
  int batch = 16;  // photos per step
  // The number of prepared objects: a step photographs some of them and replaces `exchange` of
  // them.
  int pool = 160;
  int exchange = 1;
  // The share of parametric shapes; the others are the catalogue's meshes, stretched.
  double parametric_share = 0.4;
  std::uint64_t seed = 1;
  // The initial weights, of the same kind; empty: random initialization.
  std::filesystem::path start;

  // Returns false, with the reason in `error`, for invalid values.
  bool IsValid(std::string* error) const;
};

// The means over the steps since the previous report.
struct PriorTrainingReport {
  int step = 0;
  double loss = 0.0;
  std::vector<std::pair<std::string, double>> metrics;  // name with unit, value
  double seconds = 0.0;                                 // since the start
};
using PriorTrainingListener = std::function<void(const PriorTrainingReport&)>;

// Both functions train on random photos of `meshes` (any units; may be empty) and of parametric
// shapes, write the averaged weights to `weights` at intervals, and report every 50 steps. They
// throw core::Error, and core::Cancelled, after which `trainer.resume` resumes.

// Trains the shape prior's network. Metrics: the volume's IoU at even odds, the elevation's error.
PriorTrainingReport TrainShapeNetwork(const std::vector<core::TexturedMesh>& meshes,
                                      const PriorTrainingOptions& options,
                                      const std::filesystem::path& weights,
                                      core::Progress* progress,
                                      const PriorTrainingListener& report = {});

// Trains the view prior's network, which builds on the shape prior of `shape_weights`. The loss is
// the mean squared error of the noise. The metrics are that of the clean image times the signal's
// share, and the same with the shape prior's rendering in place of the prediction.
PriorTrainingReport TrainViewNetwork(const std::vector<core::TexturedMesh>& meshes,
                                     const std::filesystem::path& shape_weights,
                                     const PriorTrainingOptions& options,
                                     const std::filesystem::path& weights, core::Progress* progress,
                                     const PriorTrainingListener& report = {});

}  // namespace simwright::asset_lift
