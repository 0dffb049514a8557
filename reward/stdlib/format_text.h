#pragma once

#include <string>

#include "reward/symbolic/value.h"

namespace simwright::reward {

// Returns a value formatted as Python's f"{value!conversion:format}" does: strings, numbers and
// flags. The conversion is 's', 'r' or none (0). Throws Fault at `position` for an invalid format
// or another kind of value: a value that differs between environments has no text.
std::string FormatValue(const Value& value, const std::string& format, char conversion,
                        Position position);

}  // namespace simwright::reward
