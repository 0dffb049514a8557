#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "asset_lift/priors/prior_training.h"
#include "asset_lift/priors/training_pool.h"
#include "nn/checkpoint.h"
#include "nn/torch.h"

namespace simwright::asset_lift {

// The network-specific part of a training.
struct PriorTraining {
  std::string kind;                      // "shape": in the checkpoint's card and in the progress
  std::vector<std::string> metrics;      // names with units
  std::uint64_t seed_offset = 0;         // of the objects, so that no two trainings share them
  torch::nn::Module* network = nullptr;  // trained
  torch::nn::Module* kept = nullptr;     // a copy that takes the averaged weights
  nn::CheckpointMetadata sizes;          // from which a reader of the weights builds the network
  nn::StoredPrecision precision = nn::StoredPrecision::kHalf;  // of the weights' file
};

struct PriorLoss {
  torch::Tensor total;          // scalar
  std::vector<double> metrics;  // as named
};

// Evaluates the network on one batch.
using PriorBatch = std::function<PriorLoss()>;
// Renders the pool's objects for a step. It is called ahead of time from another thread, while the
// network trains on the previous batch: it must not access the network.
using PriorBatchSource = std::function<PriorBatch(const TrainingPool& pool, int step)>;

// Runs the training loop of a network: objects, optimizer, reports, weights and the resume state,
// as specified in prior_training.h.
PriorTrainingReport TrainPrior(const PriorTraining& training,
                               const std::vector<core::TexturedMesh>& meshes,
                               const PriorTrainingOptions& options,
                               const std::filesystem::path& weights, core::Progress* progress,
                               const PriorTrainingListener& listener,
                               const PriorBatchSource& source);

}  // namespace simwright::asset_lift
