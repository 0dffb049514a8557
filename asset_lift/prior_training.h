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
  int batch = 16;  // photos a step
  // Objects kept ready: a step photographs some of them and exchanges `exchange` for new ones.
  int pool = 160;
  int exchange = 1;
  // Share of parametric shapes; the others are the catalogue's meshes, stretched.
  double parametric_share = 0.4;
  std::uint64_t seed = 1;
  // Weights to begin with, of the same kind; empty: drawn at random.
  std::filesystem::path start;

  // False, with the reason, for values that no training can have.
  bool IsValid(std::string* error) const;
};

// Means over the steps since the report before.
struct PriorTrainingReport {
  int step = 0;
  double loss = 0.0;
  std::vector<std::pair<std::string, double>> metrics;  // name with unit, value
  double seconds = 0.0;                                 // since the start
};
using PriorTrainingListener = std::function<void(const PriorTrainingReport&)>;

// Both train on random photos of `meshes` (any units; may be empty) and of parametric shapes, write
// the averaged weights to `weights` every so often, and report every 50 steps. They throw
// core::Error, and core::Cancelled after which `trainer.resume` goes on.

// The shape prior's network. Metrics: the volume's IoU at even odds, the elevation's error.
PriorTrainingReport TrainShapeNetwork(const std::vector<core::TexturedMesh>& meshes,
                                      const PriorTrainingOptions& options,
                                      const std::filesystem::path& weights,
                                      core::Progress* progress,
                                      const PriorTrainingListener& report = {});

// The view prior's network, which builds upon the shape prior of `shape_weights`. The loss is the
// mean squared error of the noise; metrics: that of the clean picture times the signal's share, and
// the same for taking the shape prior's drawing for it.
PriorTrainingReport TrainViewNetwork(const std::vector<core::TexturedMesh>& meshes,
                                     const std::filesystem::path& shape_weights,
                                     const PriorTrainingOptions& options,
                                     const std::filesystem::path& weights, core::Progress* progress,
                                     const PriorTrainingListener& report = {});

}  // namespace simwright::asset_lift
