#include "validation/check_report.h"

#include <cstdio>

#include "core/json.h"

namespace simwright::validation {
namespace {

// Returns a result as a standalone finding: its sentence starts with its figure.
core::Finding InWords(core::Finding row) {
  char figure[40];
  std::snprintf(figure, sizeof(figure), "%.4g ", row.figure);
  row.sentence = figure + row.sentence;
  return row;
}

std::string FailureOf(const CheckReport& report) {
  int failed = 0;
  std::string names;
  for (const core::Finding& row : report.results) {
    if (row.severity != core::Severity::kError) continue;
    ++failed;
    names += (names.empty() ? "" : ", ") + row.code;
  }
  return "fails " + std::to_string(failed) + " of " + std::to_string(report.results.size()) +
         " properties of its check: " + names;
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

core::Findings CheckReport::Warnings() const {
  core::Findings warnings;
  for (const core::Finding& row : results) {
    if (row.severity == core::Severity::kWarning) warnings.push_back(InWords(row));
  }
  return warnings;
}

core::Findings NotableResults(const CheckReport& report) {
  core::Findings results;
  for (const core::Finding& row : report.results) {
    if (row.severity != core::Severity::kInfo) results.push_back(InWords(row));
  }
  return results;
}

CheckFailed::CheckFailed(const CheckReport& report, const std::string& name)
    : core::Error(FailureOf(report), name, "--no-check writes it anyway") {
  for (const core::Finding& row : report.results) {
    if (row.severity != core::Severity::kError) continue;
    rows_.push_back(InWords(row));
    rows_.back().place = name;
  }
}

void RequirePassed(const CheckReport& report, const std::string& name) {
  if (!report.passed()) throw CheckFailed(report, name);
}

const char* GradeSentence(Grade grade) {
  return grade == Grade::kPass       ? "passes"
         : grade == Grade::kWarnings ? "passes with warnings"
                                     : "does not pass";
}

namespace {

std::string TableRow(const char* verdict, const core::Finding& row) {
  char line[96];
  std::snprintf(line, sizeof(line), "  %-4s  %-20s %12.4g  ", verdict, row.code.c_str(),
                row.figure);
  return line + row.sentence + "\n";
}

core::OrderedJson AppearanceJson(const Appearance& appearance) {
  core::OrderedJson json{{"grade", LookName(appearance.look)},
                         {"reasons", appearance.reasons},
                         {"remedy", appearance.remedy}};
  json["measures"] = core::OrderedJson::array();
  for (const core::Finding& row : appearance.measures) {
    json["measures"].push_back(
        {{"property", row.code}, {"figure", row.figure}, {"sentence", row.sentence}});
  }
  return json;
}

}  // namespace

std::string AppearanceSentence(const Appearance& appearance) {
  std::string sentence = std::string("it looks ") + LookName(appearance.look);
  if (!appearance.reasons.empty()) sentence += ": " + appearance.reasons;
  return sentence;
}

std::string CheckTable(const CheckReport& report) {
  std::string table = report.subject + "\n";
  for (const core::Finding& row : report.results) table += TableRow(Verdict(row), row);
  if (report.appearance) {
    for (const core::Finding& row : report.appearance->measures) table += TableRow("look", row);
  }
  table += std::string("  ") + GradeSentence(report.grade()) + "\n";
  if (!report.appearance) return table;
  table += "  " + AppearanceSentence(*report.appearance) + "\n";
  if (report.appearance->remedy.empty()) return table;
  return table + "  to improve it: " + report.appearance->remedy + "\n";
}

std::string CheckJson(const CheckReport& report) {
  core::OrderedJson json;
  json["subject"] = report.subject;
  json["passed"] = report.passed();
  json["grade"] = GradeName(report.grade());
  json["rows"] = core::OrderedJson::array();
  for (const core::Finding& row : report.results) {
    json["rows"].push_back({{"property", row.code},
                            {"verdict", Verdict(row)},
                            {"figure", row.figure},
                            {"sentence", row.sentence}});
  }
  if (report.appearance) json["appearance"] = AppearanceJson(*report.appearance);
  return core::JsonText(json);
}

}  // namespace simwright::validation
