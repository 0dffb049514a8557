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

// A batch: says what the network makes of it.
using PriorBatch = std::function<PriorLoss()>;
// Photographs the pool's objects for a step. Called ahead of time from another thread, while the
// network learns from the batch before: it must leave the network alone.
using PriorBatchSource = std::function<PriorBatch(const TrainingPool& pool, int step)>;

// The loop around a network's steps: objects, optimiser, reports, weights and the state to go on
// from, as promised in prior_training.h.
PriorTrainingReport TrainPrior(const PriorTraining& training,
                               const std::vector<core::TexturedMesh>& meshes,
                               const PriorTrainingOptions& options,
                               const std::filesystem::path& weights, core::Progress* progress,
                               const PriorTrainingListener& listener,
                               const PriorBatchSource& source);

}  // namespace simwright::asset_lift
