#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::reward {

// Returns the name in `known` that is spelt most like `name`; empty if none is close.
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

// Returns "; did you mean X?" for the nearest name, or the first few of `known`, or nothing.
std::string Suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace simwright::reward
