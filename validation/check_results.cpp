#include "validation/check_results.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "validation/check.h"

namespace simwright::validation {
namespace {

std::string Rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

const char* Verdict(const core::Finding& row) {
  switch (row.severity) {
    case core::Severity::kError:
      return "FAIL";
    case core::Severity::kWarning:
      return "warn";
    default:
      return "pass";
  }
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

const char* GradeSentence(Grade grade) {
  return grade == Grade::kPass       ? "passes"
         : grade == Grade::kWarnings ? "passes with warnings"
                                     : "does not pass";
}

std::string CheckTable(const CheckReport& report) {
  std::string table = report.subject + "\n";
  for (const core::Finding& row : report.results) {
    char line[96];
    std::snprintf(line, sizeof(line), "  %-4s  %-20s %12s  ", Verdict(row), row.code.c_str(),
                  Rounded(row.figure).c_str());
    table += line + row.sentence + "\n";
  }
  return table + "  " + GradeSentence(report.grade()) + "\n";
}

std::string CheckJson(const CheckReport& report) {
  nlohmann::ordered_json json;
  json["subject"] = report.subject;
  json["passed"] = report.passed();
  json["grade"] = GradeName(report.grade());
  json["rows"] = nlohmann::ordered_json::array();
  for (const core::Finding& row : report.results) {
    json["rows"].push_back({{"property", row.code},
                            {"verdict", Verdict(row)},
                            {"figure", row.figure},
                            {"sentence", row.sentence}});
  }
  return json.dump(2) + "\n";
}

}  // namespace simwright::validation
