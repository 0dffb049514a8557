#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "nn/torch.h"

namespace simwright::nn {

// What a weights file says of itself: its kind and sizes, so that the right network is built.
using CheckpointFacts = std::map<std::string, std::string>;

// Writes the module's parameters and buffers in half precision (what ships is half as large and as
// good), beside and renamed in. `facts` must hold "kind".
void SaveCheckpoint(const torch::nn::Module& module, const CheckpointFacts& facts,
                    const std::filesystem::path& path);

// The facts of a checkpoint. Throws core::Error: missing, damaged, or of another kind than `kind`.
CheckpointFacts ReadCheckpointFacts(const std::filesystem::path& path, const std::string& kind);

// Fills the module. Throws core::Error where the file is missing, damaged, or holds other names or
// shapes than the module, naming the first.
void LoadCheckpoint(const std::filesystem::path& path, torch::nn::Module* module);

}  // namespace simwright::nn
