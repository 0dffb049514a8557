#pragma once

#include <string>

namespace simwright::physics_params {

// Returns `value` with three significant digits, as sentences for people show it: "0.0123",
// "1e+06".
std::string RoundedText(double value);

}  // namespace simwright::physics_params
