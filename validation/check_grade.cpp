#include "validation/check_grade.h"

#include <algorithm>

namespace simwright::validation {

const char* GradeName(Grade grade) {
  return grade == Grade::kPass ? "pass" : grade == Grade::kWarnings ? "pass with warnings" : "fail";
}

Grade GradeOf(const core::Findings& results) {
  core::Severity worst = core::Severity::kInfo;
  for (const core::Finding& row : results) worst = std::max(worst, row.severity);
  return worst == core::Severity::kError     ? Grade::kFail
         : worst == core::Severity::kWarning ? Grade::kWarnings
                                             : Grade::kPass;
}

GradedLimit InUnit(const GradedLimit& limit, double factor) {
  return {limit.good * factor, limit.worst * factor};
}

core::Severity SeverityAtMost(double figure, const GradedLimit& limit) {
  if (figure <= limit.good) return core::Severity::kInfo;
  return figure <= limit.worst ? core::Severity::kWarning : core::Severity::kError;
}

core::Severity SeverityAtLeast(double figure, const GradedLimit& limit) {
  if (figure >= limit.good) return core::Severity::kInfo;
  return figure >= limit.worst ? core::Severity::kWarning : core::Severity::kError;
}

}  // namespace simwright::validation
