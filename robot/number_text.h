#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace simwright::robot {

// Appends the shortest text that parses to `value`, always with a decimal point: "0.0", "-1.5",
// "1.0e-05". YAML 1.1 parses "1e-05" as a string.
void AppendNumber(double value, std::string* text);

// Returns `value` with up to six significant digits, for messages: "0.5", "1e-05".
std::string DisplayText(double value);

// Parses all of `text` as a finite number; returns nullopt if it is anything else.
std::optional<double> NumberFrom(std::string_view text);
std::optional<std::int64_t> IntegerFrom(std::string_view text);

// Returns `text` without spaces, tabs and carriage returns at both ends.
std::string_view Trimmed(std::string_view text);

}  // namespace simwright::robot
