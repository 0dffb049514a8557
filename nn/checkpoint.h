#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "nn/torch.h"

namespace simwright::nn {

// The metadata of a weights file: the kind and sizes from which the network is built.
using CheckpointMetadata = std::map<std::string, std::string>;

enum class StoredPrecision {
  kHalf,       // no loss of quality was measured
  kEightBits,  // large matrices as 8-bit integers with a scale per row: within 1/254 of its largest
};

// Writes the module's parameters and buffers to a sibling file that is renamed into place.
// `metadata` must contain "kind".
void SaveCheckpoint(const torch::nn::Module& module, const CheckpointMetadata& metadata,
                    const std::filesystem::path& path,
                    StoredPrecision precision = StoredPrecision::kHalf);

// Reads the metadata of a weights file before a network is built. Throws like LoadCheckpoint.
CheckpointMetadata ReadCheckpointMetadata(const std::filesystem::path& path,
                                          const std::string& kind);

// Loads the module's weights and returns the metadata. Throws core::Error if the file is missing,
// damaged, of another kind than `kind`, or holds other names or shapes than the module, naming the
// first mismatch.
CheckpointMetadata LoadCheckpoint(const std::filesystem::path& path, const std::string& kind,
                                  torch::nn::Module* module);

}  // namespace simwright::nn
