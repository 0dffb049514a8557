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
  nn::TrainerOptions trainer;
  int batch = 8;            // pictures per step
  int pool = 4000;          // pictures kept in memory: 200 KB each
  int exchange = 3;         // pictures of the pool that each step replaces by new ones
  double part_share = 0.5;  // of pictures of which only an enlarged part is shown
  DetectorNetworkOptions network;
  TableSceneOptions scenes;
  std::uint64_t seed = 1;
  std::filesystem::path start;  // weights from which the training starts; empty: random ones

  DetectorTrainingOptions();
  // Returns false for invalid values, with the reason in `error` unless it is null.
  bool IsValid(std::string* error) const;
};

// Trains the detector's network on random scenes and writes the averaged weights to the file
// `weights` every `trainer.save_every` steps; reports every 50 steps and returns the last report.
// The metrics are the IoU of the objects' pixels and the mean error of the offsets in pixels.
// Throws core::Error for invalid options, for `start` weights that cannot be read or are of other
// sizes, and for weights that cannot be written, and core::Cancelled after Ctrl-C; `trainer.resume`
// continues a cancelled training: its state takes the place of `start`.
asset_lift::PriorTrainingReport TrainDetector(const TableSceneSources& sources,
                                              const DetectorTrainingOptions& options,
                                              const std::filesystem::path& weights,
                                              core::Progress* progress,
                                              const asset_lift::PriorTrainingListener& report = {});

}  // namespace simwright::twin
