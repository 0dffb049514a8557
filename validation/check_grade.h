#pragma once

#include "core/finding.h"

// Grades that the checks of rigid and articulated assets share: small faults warn, large ones fail.
namespace simwright::validation {

// An asset's grade: the worst of its check results. An asset with warnings is written and usable;
// its findings describe the faults.
enum class Grade { kPass, kWarnings, kFail };

// Returns "pass", "pass with warnings" or "fail", for people and for --json.
const char* GradeName(Grade grade);

// Returns kFail if any finding is an error, else kWarnings if any is a warning, else kPass.
Grade GradeOf(const core::Findings& results);

// Bounds, in the figure's unit, of a figure that should be small (CheckResults::AtMost: good <=
// worst) or large (CheckResults::AtLeast: good >= worst). A figure within `good` passes, one within
// `worst` warns, any other fails. NaN fails.
struct GradedLimit {
  double good = 0.0;
  double worst = 0.0;
};

// Returns the limit in another unit, `factor` of which make one of the original unit.
GradedLimit InUnit(const GradedLimit& limit, double factor);

core::Severity SeverityAtMost(double figure, const GradedLimit& limit);
core::Severity SeverityAtLeast(double figure, const GradedLimit& limit);

}  // namespace simwright::validation
