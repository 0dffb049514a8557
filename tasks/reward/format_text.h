#pragma once

#include <string>

#include "tasks/reward/value.h"

namespace simwright::tasks::reward {

// A value as Python's f"{value!conversion:format}" writes it: strings, numbers and flags. The
// conversion is 's', 'r' or none (0). Throws Fault at `position` where there is no such format or
// the value is none of these: what differs between environments has no text.
std::string FormatValue(const Value& value, const std::string& format, char conversion,
                        Position position);

}  // namespace simwright::tasks::reward
