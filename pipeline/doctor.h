#pragma once

#include "core/finding.h"

namespace simwright::pipeline {

// What this machine offers: threads and memory, space for temporary files, WordNet, ray speed,
// and whether both engines work. Severity kError where something needed is broken, kWarning where
// something optional is missing or slow; each sentence says how to mend it. Takes about a second.
core::Findings Examine();

}  // namespace simwright::pipeline
