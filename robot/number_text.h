#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace simwright::robot {

// The shortest text that reads back as `value`, always with a point: "0.0", "-1.5", "1.0e-05".
// YAML 1.1 would take "1e-05" for a word.
void AppendNumber(double value, std::string* text);

// The whole of `text` as a finite number; none where it is anything else.
std::optional<double> NumberFrom(std::string_view text);
std::optional<std::int64_t> IntegerFrom(std::string_view text);

// Without blanks, tabs and carriage returns at both ends.
std::string_view Trimmed(std::string_view text);

}  // namespace simwright::robot
