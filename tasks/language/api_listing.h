#pragma once

#include <span>
#include <string>

#include "reward/environment_api.h"

namespace simwright::tasks {

// Returns the environment's functions as the prompt lists them, one per line:
// "env.get_position(asset_name)  # [N, 3]: where an asset is, m".
std::string ApiListing();

// Returns the call alone, e.g. "env.get_position(asset_name)"; optional arguments stand in
// brackets.
std::string ApiCall(const reward::ApiFunction& function);

// Returns the torch expressions that the prompt lists, in terms of `x`, [N, 3], and `a`, `b`, [N].
// Reward programs may use far more (docs/rewards.md).
std::span<const char* const> TensorExpressions();

}  // namespace simwright::tasks
