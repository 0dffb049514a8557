#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/finding.h"

namespace simwright::core {

// The array `findings` of every command's --json: an object a finding with "code", "severity"
// (note, warning, error), "place", "sentence", "remedy" and "figure" (null where not finite).
nlohmann::ordered_json FindingsJson(const Findings& findings);

}  // namespace simwright::core
