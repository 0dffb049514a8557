#pragma once

#include "core/finding.h"

namespace simwright::pipeline {

// What this machine offers: threads and memory, space for temporary files, ray speed, and what
// ExamineSoftware says. Severity kError where something needed is broken, kWarning where
// something optional is missing or slow; each remedy says how to mend it. Takes about a second.
core::Findings Examine();

}  // namespace simwright::pipeline
