#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "asset_lift/priors/prior_training.h"
#include "core/progress.h"
#include "nn/trainer_options.h"
#include "twin/detector_network_options.h"
#include "twin/table_scene.h"

namespace simwright::twin {

struct DetectorTrainingOptions {
  nn::TrainerOptions trainer;         // of the objects' pixels
  nn::TrainerOptions camera_trainer;  // of the camera, which is trained after these
  int batch = 8;                      // pictures per step
  int pool = 4000;                    // pictures kept in memory: 200 KB each
  int exchange = 3;                   // pictures of the pool that each step replaces by new ones
  double part_share = 0.5;            // of pictures of which only an enlarged part is shown
  DetectorNetworkOptions network;
  TableSceneOptions scenes;
  std::uint64_t seed = 1;

  DetectorTrainingOptions();
  // Returns false for invalid values, with the reason in `error` unless it is null.
  bool IsValid(std::string* error) const;
};

// Trains the detector's network on random scenes and writes the averaged weights to the file
// `weights` every `save_every` steps; reports every 50 steps and returns the last report. The
// metrics are the IoU of the objects' pixels and the mean error of the offsets in pixels; then, of
// the camera's part, the mean errors of elevation and roll (degrees) and of the logarithms of focal
// length and height. Throws core::Error for invalid options and for weights that cannot be written,
// and core::Cancelled after Ctrl-C; `resume` of both trainers continues a cancelled training.
asset_lift::PriorTrainingReport TrainDetector(const TableSceneSources& sources,
                                              const DetectorTrainingOptions& options,
                                              const std::filesystem::path& weights,
                                              core::Progress* progress,
                                              const asset_lift::PriorTrainingListener& report = {});

}  // namespace simwright::twin
