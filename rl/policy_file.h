#pragma once

#include <filesystem>

#include "rl/policy.h"

namespace simwright::rl {

// The file of a shipped policy: the actor's weights, the observation scale and the metadata,
// without the critic. A dictionary of tensors as nn/tensor_file.h writes it (docs/formats.md).

enum class Precision { kHalf, kFloat };

// Writes a temporary file and renames it to `path`. Weights in half precision change actions by
// about 1e-3 and take half the space; scales and standard deviations stay floats. Throws
// core::Error.
void WritePolicy(const Policy& policy, const std::filesystem::path& path,
                 Precision precision = Precision::kFloat);

// Throws core::Error if the file is missing, damaged, or of another kind or version.
Policy ReadPolicy(const std::filesystem::path& path);

}  // namespace simwright::rl
