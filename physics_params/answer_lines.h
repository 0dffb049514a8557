#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::physics_params {

// Converts an answer to plain lines "label: values" from lines of prose, Markdown lists and
// headings, tables (one row per object or per quantity) or JSON (ranges as [a, b], {"min", "max"}
// or text; units in the keys). A heading or the name of a table's row becomes "object: NAME". The
// lines are in lower case, see PlainText. Reads at most the first 64 KiB.
std::vector<std::string> AnswerLines(std::string_view answer);

}  // namespace simwright::physics_params
