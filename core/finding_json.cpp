#include "core/finding_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/finding_text.h"

namespace simwright::core {

nlohmann::ordered_json FindingsJson(const Findings& findings) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    nlohmann::ordered_json entry;
    entry["code"] = finding.code;
    entry["severity"] = SeverityName(finding.severity);
    entry["place"] = finding.place;
    entry["sentence"] = finding.sentence;
    entry["remedy"] = finding.remedy;
    entry["figure"] = std::isfinite(finding.figure) ? nlohmann::ordered_json(finding.figure)
                                                    : nlohmann::ordered_json(nullptr);
    list.push_back(entry);
  }
  return list;
}

}  // namespace simwright::core
