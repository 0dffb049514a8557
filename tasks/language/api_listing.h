#pragma once

#include <span>
#include <string>

#include "tasks/reward/environment_api.h"

namespace simwright::tasks {

// The environment's functions as a language model is told of them, one a line:
// "env.get_position(asset_name)  # [N, 3]: where an asset is, m".
std::string ApiListing();

// The call alone, e.g. "env.get_position(asset_name)"; what may be left out stands in brackets.
std::string ApiCall(const ApiFunction& function);

// What of torch a language model is told of: an expression of `x`, [N, 3], and `a`, `b`, [N].
// Reward programs may use far more (docs/rewards.md).
std::span<const char* const> TensorExpressions();

}  // namespace simwright::tasks
