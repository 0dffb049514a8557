#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "asset_lift/prior_training.h"
#include "asset_lift/training_pool.h"
#include "nn/torch.h"

namespace simwright::asset_lift {

// What sets the training of one network apart from another's.
struct PriorTraining {
  std::string kind;                  // "shape": of the checkpoint's card, and named in the progress
  std::vector<std::string> metrics;  // names with units
  std::uint64_t seed_offset = 0;     // of the objects, so that no two trainings see the same
  torch::nn::Module* network = nullptr;  // trained
  torch::nn::Module* kept = nullptr;     // another of its kind: takes the averaged weights
};

struct PriorLoss {
  torch::Tensor total;          // scalar
  std::vector<double> metrics;  // as named
};

// Draws a batch of photos of the pool's objects for a step and says what the network makes of them.
using PriorStep = std::function<PriorLoss(const TrainingPool& pool, int step)>;

// The loop around a network's steps: objects, optimiser, reports, weights and the state to go on
// from, as promised in prior_training.h.
PriorTrainingReport TrainPrior(const PriorTraining& training,
                               const std::vector<core::TexturedMesh>& meshes,
                               const PriorTrainingOptions& options,
                               const std::filesystem::path& weights, core::Progress* progress,
                               const PriorTrainingListener& listener, const PriorStep& step);

}  // namespace simwright::asset_lift
