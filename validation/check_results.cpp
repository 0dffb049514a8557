#include "validation/check_results.h"

#include <cstdio>

namespace simwright::validation {
namespace {

std::string Rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

}  // namespace

void CheckResults::Report(const std::string& code, double figure, const std::string& what) {
  rows_.push_back({code, core::Severity::kInfo, place_, what, figure});
}

void CheckResults::Require(const std::string& code, bool passes, double figure,
                           const std::string& what) {
  rows_.push_back(
      {code, passes ? core::Severity::kInfo : core::Severity::kError, place_, what, figure});
}

void CheckResults::AtMost(const std::string& code, double figure, double limit,
                          const std::string& what) {
  Require(code, figure <= limit, figure, what + ", at most " + Rounded(limit));
}

void CheckResults::AtMost(const std::string& code, double figure, const GradedLimit& limit,
                          const std::string& what) {
  const core::Severity severity = SeverityAtMost(figure, limit);
  const bool failed = severity == core::Severity::kError;
  Add(code, severity, figure, what + ", at most " + Rounded(failed ? limit.worst : limit.good));
}

void CheckResults::AtLeast(const std::string& code, double figure, const GradedLimit& limit,
                           const std::string& what) {
  const core::Severity severity = SeverityAtLeast(figure, limit);
  const bool failed = severity == core::Severity::kError;
  Add(code, severity, figure, what + ", at least " + Rounded(failed ? limit.worst : limit.good));
}

void CheckResults::Add(const std::string& code, core::Severity severity, double figure,
                       const std::string& what) {
  rows_.push_back({code, severity, place_, what, figure});
}

void CheckResults::Fail(const std::string& code, const std::string& why) {
  rows_.push_back({code, core::Severity::kError, place_, why, 0.0});
}

void CheckResults::Warn(const core::Finding& finding) {
  rows_.push_back(finding);
}

}  // namespace simwright::validation
