#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"

namespace simwright::asset_lift {

struct ShapeTrainingOptions {
  int steps = 6000;
  int batch = 16;
  double learning_rate = 8e-4;  // at the top of a warm-up of 3 % and a cosine down to a twentieth
  double weight_decay = 0.01;
  double ema_decay = 0.998;
  // Objects kept ready: a step photographs `batch` of them and exchanges `exchange` for new ones.
  int pool = 160;
  int exchange = 1;
  // Share of parametric shapes; the others are the catalogue's meshes, stretched.
  double parametric_share = 0.4;
  std::uint64_t seed = 1;
  // Steps between weights that are written to disk, with all that going on needs.
  int save_every = 250;
  bool resume = false;  // goes on from what an earlier run left at the same path

  // False, with the reason, for values that no training can have.
  bool IsValid(std::string* error) const;
};

// Means over the last steps before a report.
struct ShapeTrainingReport {
  int step = 0;
  double loss = 0.0;
  double occupancy_iou = 0.0;    // of volumes, at the level 0.5, on new photos of training objects
  double elevation_error = 0.0;  // degrees
  double seconds = 0.0;          // since the start
};

// Trains a shape network on random photos of `meshes` (any units; may be empty) and of parametric
// shapes, and writes its averaged weights to `weights`. `report` hears from it every 50 steps.
// Throws core::Error, core::Cancelled (the weights so far are kept).
ShapeTrainingReport TrainShapeNetwork(
    const std::vector<core::TexturedMesh>& meshes, const ShapeTrainingOptions& options,
    const std::filesystem::path& weights, core::Progress* progress,
    const std::function<void(const ShapeTrainingReport&)>& report = {});

}  // namespace simwright::asset_lift
