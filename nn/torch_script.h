#pragma once

#include <filesystem>

#include "nn/torch.h"
// Include only after nn/torch.h, and only to run a user's module.
#include <torch/script.h>

namespace simwright::nn {

// Loads a user's TorchScript module. Throws core::Error if the file is missing or not TorchScript.
torch::jit::script::Module LoadTorchScript(const std::filesystem::path& path);

}  // namespace simwright::nn
