#pragma once

#include <filesystem>

#include "rl/policy.h"

namespace simwright::rl {

// What ships: the actor's weights, the observations' scale and the facts, without the critic. A
// dictionary of tensors as nn/tensor_file.h writes it (docs/formats.md).

enum class Precision { kHalf, kFloat };

// Writes beside `path` and renames in. Weights in half precision act alike to about 1e-3 and take
// half the space; scales and standard deviations stay floats. Throws core::Error.
void WritePolicy(const Policy& policy, const std::filesystem::path& path,
                 Precision precision = Precision::kFloat);

// Throws core::Error: missing, damaged, of another kind or version.
Policy ReadPolicy(const std::filesystem::path& path);

}  // namespace simwright::rl
