#pragma once

#include "core/finding.h"

namespace simwright::pipeline {

// "error", "warning" or "note", as a person and --json read it.
inline const char* SeverityName(core::Severity severity) {
  return severity == core::Severity::kError     ? "error"
         : severity == core::Severity::kWarning ? "warning"
                                                : "note";
}

}  // namespace simwright::pipeline
