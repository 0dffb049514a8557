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

// What a weights file says of itself, before a network is built for it. Throws as LoadCheckpoint.
CheckpointFacts ReadCheckpointFacts(const std::filesystem::path& path, const std::string& kind);

// Fills the module and returns the facts. Throws core::Error where the file is missing, damaged, of
// another kind than `kind`, or holds other names or shapes than the module, naming the first.
CheckpointFacts LoadCheckpoint(const std::filesystem::path& path, const std::string& kind,
                               torch::nn::Module* module);

}  // namespace simwright::nn
