#include "core/finding_json.h"

#include <cmath>
#include <iterator>

#include "core/finding_text.h"

namespace simwright::core {
namespace {

constexpr const char* kStoredSeverities[] = {"info", "warning", "error"};

Severity SeverityFrom(const JsonField& field) {
  const std::string name = field.Text();
  for (std::size_t i = 0; i < std::size(kStoredSeverities); ++i) {
    const auto severity = static_cast<Severity>(i);
    if (name == kStoredSeverities[i] || name == SeverityName(severity)) return severity;
  }
  field.FailAs("info, warning or error");
}

}  // namespace

OrderedJson FindingsJson(const Findings& findings) {
  OrderedJson list = OrderedJson::array();
  for (const Finding& finding : findings) {
    OrderedJson entry;
    entry["code"] = finding.code;
    entry["severity"] = SeverityName(finding.severity);
    entry["place"] = finding.place;
    entry["sentence"] = finding.sentence;
    entry["remedy"] = finding.remedy;
    entry["figure"] =
        std::isfinite(finding.figure) ? OrderedJson(finding.figure) : OrderedJson(nullptr);
    list.push_back(entry);
  }
  return list;
}

OrderedJson StoredFindingsJson(const Findings& findings) {
  OrderedJson list = OrderedJson::array();
  for (const Finding& finding : findings) {
    OrderedJson entry;
    entry["code"] = finding.code;
    entry["severity"] = kStoredSeverities[static_cast<std::size_t>(finding.severity)];
    entry["place"] = finding.place;
    entry["sentence"] = finding.sentence;
    entry["figure"] = std::isfinite(finding.figure) ? finding.figure : 0.0;
    if (!finding.remedy.empty()) entry["remedy"] = finding.remedy;
    list.push_back(entry);
  }
  return list;
}

Findings FindingsFrom(const JsonField& field) {
  Findings findings;
  for (const JsonField& entry : field.Elements()) {
    entry.RequireMembers({"code", "severity", "place", "sentence", "figure"}, {"remedy"});
    findings.push_back({entry["code"].Text(), SeverityFrom(entry["severity"]),
                        entry["place"].Text(), entry["sentence"].Text(), entry["figure"].Number(),
                        entry.TextOr("remedy", "")});
  }
  return findings;
}

}  // namespace simwright::core
