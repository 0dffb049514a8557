#pragma once

#include <filesystem>
#include <string>

#include "rl/policy.h"

namespace simwright::rl {

// Returns the policy as an ONNX model (IR version 5, operator set 10) with the input `observation`
// (batch x O) and the output `action` (batch x A), both float32 with a dynamic first axis. The
// model scales and clips the observation, runs the network and clamps to [-1, 1], as Policy::Act
// does; only a value that is not finite, which Act counts as 0, is passed on. `metadata` becomes
// the model's metadata_props.
std::string OnnxModel(const Policy& policy, const Metadata& metadata);

// Writes the model to a temporary file and renames it to `path`. Throws core::Error.
void WriteOnnx(const Policy& policy, const Metadata& metadata, const std::filesystem::path& path);

}  // namespace simwright::rl
