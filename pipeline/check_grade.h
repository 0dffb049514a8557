#pragma once

#include "core/finding.h"

// How checks of rigid and of articulated assets judge a figure: small faults warn, large ones fail.
namespace simwright::pipeline {

// How good an asset is, by the worst row of its check. One with warnings is written and usable; the
// findings say what is wrong with it.
enum class Grade { kPass, kWarnings, kFail };

// "pass", "pass with warnings" or "fail", as a person and --json read it.
const char* GradeName(Grade grade);

// kFail where any finding is an error, else kWarnings where any is a warning.
Grade GradeOf(const core::Findings& rows);

// Bounds of a figure that should be small (CheckRows::AtMost: good <= worst) or large
// (CheckRows::AtLeast: good >= worst), in the figure's unit. Up to `good` a row passes, up to
// `worst` it warns, beyond it fails. A figure that is not a number fails.
struct GradedLimit {
  double good = 0.0;
  double worst = 0.0;
};

// The same bounds in a unit of which `factor` make one of theirs.
GradedLimit InUnit(const GradedLimit& limit, double factor);

core::Severity SeverityAtMost(double figure, const GradedLimit& limit);
core::Severity SeverityAtLeast(double figure, const GradedLimit& limit);

}  // namespace simwright::pipeline
