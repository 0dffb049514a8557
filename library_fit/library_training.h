#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "asset_lift/priors/prior_training.h"
#include "core/progress.h"
#include "nn/trainer_options.h"

namespace simwright::library_fit {

struct PriorExample;

struct LibraryTrainingOptions {
  nn::TrainerOptions trainer;
  int batch = 64;     // pictures per step
  int pool = 6000;    // pictures kept in memory: 16 KB each
  int exchange = 12;  // pictures of the pool that each step replaces by new ones
  // The sizes of the network (library_network.h); the weights' file keeps them.
  std::vector<int> channels = {48, 96, 192, 256};
  int features = 512;
  // Returns a picture of an instance among other objects; deterministic for its seed, and called
  // from several threads. `scene_share` of the pictures come from it if it is set.
  std::function<PriorExample(std::uint64_t)> scene_example;
  double scene_share = 0.5;
  std::filesystem::path start;  // weights from which the training starts; empty: random ones
  // Training seeds of instances lie in [1, kHeldOutSeed); 0 samples others.
  std::uint64_t seed = 1;

  LibraryTrainingOptions();
  // Returns false for invalid values, with the reason in `error` unless it is null.
  bool IsValid(std::string* error) const;
};

// No training uses instances of this seed or a larger one: they are held out for evaluation.
inline constexpr std::uint64_t kHeldOutSeed = 1'000'000'000;

// Trains the library prior's network on renders of random instances of all kinds, and on pictures
// of `scene_example`, and writes the averaged weights to the file `weights` every
// `trainer.save_every` steps; reports every 50 steps and returns the last report. The metrics are
// the share of pictures whose kind is right, the mean error of the azimuth of articulated kinds in
// degrees, and the mean absolute error of the sizes' logarithms. Throws core::Error for invalid
// options, for `start` weights that cannot be read or are of other sizes, and for weights that
// cannot be written, and core::Cancelled after Ctrl-C; `trainer.resume` continues a cancelled
// training: its state takes the place of `start`.
asset_lift::PriorTrainingReport TrainLibraryNetwork(
    const LibraryTrainingOptions& options, const std::filesystem::path& weights,
    core::Progress* progress, const asset_lift::PriorTrainingListener& report = {});

}  // namespace simwright::library_fit
