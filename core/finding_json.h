#pragma once

#include "core/finding.h"
#include "core/json.h"

namespace simwright::core {

// Returns the array `findings` of every command's --json output: one object per finding with
// "code", "severity" (note, warning, error), "place", "sentence", "remedy" and "figure" (null if
// not finite).
OrderedJson FindingsJson(const Findings& findings);

// Returns the array `findings` of asset.json and tasks.json: one object per finding with "code",
// "severity" (info, warning, error), "place", "sentence", "figure" and, if there is one, "remedy".
OrderedJson StoredFindingsJson(const Findings& findings);

// Reads the findings of either array. Throws core::Error if it is damaged.
Findings FindingsFrom(const JsonField& field);

}  // namespace simwright::core
