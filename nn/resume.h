#pragma once

#include <filesystem>

#include "nn/ema.h"
#include "nn/torch.h"

namespace simwright::nn {

// All that a training needs to go on where it stopped, in full precision.
void SaveTrainingState(const std::filesystem::path& path, int step, const torch::nn::Module& module,
                       const torch::optim::Optimizer& optimizer, const Ema& average);

// Restores it and returns the step to go on from; 0, and nothing is touched, where `path` does not
// exist. Throws core::Error for a damaged file or one of another network.
int LoadTrainingState(const std::filesystem::path& path, torch::nn::Module* module,
                      torch::optim::Optimizer* optimizer, Ema* average);

}  // namespace simwright::nn
