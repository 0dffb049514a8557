#pragma once

#include <string>

#include "core/finding.h"
#include "validation/check_grade.h"

namespace simwright::validation {

// Collects the results of a check: a figure, its limit, and whether it passes.
class CheckResults {
 public:
  explicit CheckResults(std::string place) : place_(std::move(place)) {}

  void Report(const std::string& code, double figure, const std::string& what);
  void Require(const std::string& code, bool passes, double figure, const std::string& what);
  void AtMost(const std::string& code, double figure, double limit, const std::string& what);
  // Grades `figure` by `limit`. The sentence ends with the violated bound.
  void AtMost(const std::string& code, double figure, const GradedLimit& limit,
              const std::string& what);
  void AtLeast(const std::string& code, double figure, const GradedLimit& limit,
               const std::string& what);
  // Adds a result with a given severity.
  void Add(const std::string& code, core::Severity severity, double figure,
           const std::string& what);
  void Fail(const std::string& code, const std::string& why);
  void Warn(const core::Finding& finding);

  core::Findings Take() { return std::move(rows_); }

 private:
  std::string place_;
  core::Findings rows_;
};

}  // namespace simwright::validation
