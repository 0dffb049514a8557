#pragma once

#include <filesystem>

#include "rl/policy.h"

namespace simwright::rl {

// Writes the policy as a TorchScript module whose `forward` maps an observation (batch x O) to the
// action (batch x A), both float32, as Policy::Act does. The module's archive holds `metadata` as
// JSON in the extra file "metadata.json" (torch.jit.load(..., _extra_files)). Writes a temporary
// file and renames it to `path`. Throws core::Error.
void WriteTorchScript(const Policy& policy, const Metadata& metadata,
                      const std::filesystem::path& path);

}  // namespace simwright::rl
