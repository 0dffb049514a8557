#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::tasks::reward {

// The one of `known` that is spelt most like `name`; empty where none is near.
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

// "; did you mean X?" for the nearest name, or the first few of `known`, or nothing.
std::string Suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace simwright::tasks::reward
