#include "cli/build_information.h"

#include <algorithm>
#include <sstream>

namespace simwright::cli {

std::vector<Component> BuiltWith() {
  std::vector<Component> components;
  std::istringstream pairs(SIMWRIGHT_BUILT_WITH);  // NAME=VERSION|NAME=VERSION...
  for (std::string pair; std::getline(pairs, pair, '|');) {
    const size_t at = pair.find('=');
    components.emplace_back(pair.substr(0, at), pair.substr(at + 1));
  }
  return components;
}

std::string VersionText() {
  const std::vector<Component> components = BuiltWith();
  size_t width = 0;
  for (const Component& component : components) width = std::max(width, component.first.size());
  std::string text = "simwright " SIMWRIGHT_VERSION "\n";
  for (const auto& [name, version] : components) {
    text += "  " + name + std::string(width + 2 - name.size(), ' ') + version + "\n";
  }
  return text;
}

}  // namespace simwright::cli
