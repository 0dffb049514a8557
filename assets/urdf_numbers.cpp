#include "assets/urdf_numbers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include <tinyxml2.h>

namespace simwright::assets {
namespace {

using tinyxml2::XMLElement;

bool IsNumeric(std::string_view attribute) {
  static const std::set<std::string_view> kNames{
      "xyz",    "rpy",      "rgba",    "size",     "scale",      "radius", "length", "value",
      "ixx",    "ixy",      "ixz",     "iyy",      "iyz",        "izz",    "lower",  "upper",
      "effort", "velocity", "damping", "friction", "multiplier", "offset"};
  return kNames.contains(attribute);
}

// Returns the numbers of `text` separated by spaces; empty if a word is not a number.
std::string Cleaned(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  std::istringstream words(text);
  std::string cleaned;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    const std::string_view rest(end);
    if (end == word.c_str() || !std::isfinite(value) ||
        !(rest.empty() || rest == "." || rest == "f")) {
      return "";
    }
    if (!cleaned.empty()) cleaned += ' ';
    cleaned.append(word, 0, static_cast<size_t>(end - word.c_str()));
  }
  return cleaned;
}

// Returns true if `text` consists of numbers separated by white space.
bool IsClean(const std::string& text) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    if (end == word.c_str() || *end != '\0') return false;
  }
  return true;
}

}  // namespace

void RepairNumbers(XMLElement* robot, core::Findings* findings) {
  for (auto* child = robot->FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string_view kind = child->Name();
    if (kind == "gazebo" || kind == "transmission") continue;
    for (auto* a = child->FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string text = a->Value();
      if (!IsNumeric(a->Name()) || IsClean(text)) continue;
      const std::string cleaned = Cleaned(text);
      if (cleaned.empty()) continue;
      findings->push_back({"urdf-numbers", core::Severity::kWarning,
                           "line " + std::to_string(child->GetLineNum()),
                           std::string(a->Name()) + "=\"" + text.substr(0, 60) +
                               "\" is read as \"" + cleaned.substr(0, 60) + "\"",
                           0.0, "write numbers with spaces between them"});
      child->SetAttribute(a->Name(), cleaned.c_str());
    }
    RepairNumbers(child, findings);
  }
}

}  // namespace simwright::assets
