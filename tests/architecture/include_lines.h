#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace simwright {

// The modules and their floors (docs/architecture.md).
inline const std::map<std::string, int> kFloor = {
    {"core", 0},         {"geometry", 1},   {"nn", 1},          {"render", 1},
    {"llm", 1},          {"reward", 1},     {"texture", 2},     {"physics_params", 2},
    {"rl", 2},           {"asset_lift", 3}, {"assets", 3},      {"library", 4},
    {"asset_looks", 7},  {"capture", 4},    {"library_fit", 5}, {"robot", 4},
    {"sim", 5},          {"tasks", 6},      {"asset_build", 6}, {"twin", 6},
    {"scene", 6},        {"validation", 7}, {"skills", 8},      {"importers", 7},
    {"manipulation", 7}, {"workflows", 9},  {"steering", 7},    {"certificate", 8},
    {"viewer", 10},      {"cli", 11},       {"python", 11},     {"proposals", 4},
    {"factory", 10},     {"transfer", 10}};

// An include line of a module.
struct Include {
  std::string module, stem, file, target;
  int line;
};

// Returns the include lines of all modules.
inline std::vector<Include> AllIncludes() {
  std::vector<Include> includes;
  const std::regex line_pattern("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
  for (const auto& [module, floor] : kFloor) {
    const std::filesystem::path folder = std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / module;
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        std::smatch match;
        if (std::regex_search(line, match, line_pattern)) {
          includes.push_back({module, module + "/" + entry.path().stem().string(),
                              entry.path().string(), match[1], number});
        }
      }
    }
  }
  return includes;
}

}  // namespace simwright
