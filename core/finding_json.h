#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/finding.h"

namespace simwright::core {

// Returns the array `findings` of every command's --json output: one object per finding with
// "code", "severity" (note, warning, error), "place", "sentence", "remedy" and "figure" (null if
// not finite).
nlohmann::ordered_json FindingsJson(const Findings& findings);

}  // namespace simwright::core
