#pragma once

#include <string>
#include <vector>

namespace simwright::core {

enum class Severity { kInfo, kWarning, kError };

// One result that a check, a linter or a reader reports.
struct Finding {
  std::string code;  // stable short name, e.g. "urdf-missing-mesh"
  Severity severity = Severity::kInfo;
  std::string place;        // file, element, row; may be empty
  std::string sentence;     // human-readable
  double figure = 0.0;      // the measured value, if any
  std::string remedy = {};  // what the reader can do; may be empty
};

using Findings = std::vector<Finding>;

}  // namespace simwright::core
