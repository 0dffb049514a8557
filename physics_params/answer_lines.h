#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::physics_params {

// An answer's statements as plain lines "label: values", whatever form they came in: lines of
// prose, Markdown lists and headings, tables (a row an object, or a row a quantity), JSON (ranges
// as [a, b], {"min", "max"} or text; units in the keys). A heading or the name of a table's row
// becomes "object: NAME". In lower case, see PlainText. At most the first 64 KiB are read.
std::vector<std::string> AnswerLines(std::string_view answer);

}  // namespace simwright::physics_params
