#pragma once

#include <string>
#include <utility>
#include <vector>

namespace simwright::cli {

// A component and its version, such as {"Eigen", "3.4.0"}.
using Component = std::pair<std::string, std::string>;

// Returns what the program was compiled with: first the compiler, the kind of build and the
// processor, then the libraries in alphabetical order. Versions are those that CMake found.
std::vector<Component> BuiltWith();

// Returns "simwright VERSION" and a line per component, with a line break at the end.
std::string VersionText();

}  // namespace simwright::cli
