#pragma once

#include <filesystem>

#include "nn/torch.h"
// After nn/torch.h, and only where a user's module is run.
#include <torch/script.h>

namespace simwright::nn {

// A TorchScript module of a user's. Throws core::Error: missing, or no TorchScript.
torch::jit::script::Module LoadScript(const std::filesystem::path& path);

}  // namespace simwright::nn
