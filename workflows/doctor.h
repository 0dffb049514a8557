#pragma once

#include "core/finding.h"

namespace simwright::workflows {

// Examines this machine: threads and memory, space for temporary files, ray casting speed, and the
// results of ExamineSoftware. The severity is kError if something required is broken, and kWarning
// if something optional is missing or slow; each remedy says how to repair it. Takes about a
// second.
core::Findings Examine();

}  // namespace simwright::workflows
