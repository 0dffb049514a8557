#pragma once

#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace simwright::llm {

// Parses `text`; returns a discarded value (is_discarded()) if it is not JSON or nested deeper than
// 64 levels, which no valid answer needs and which would exhaust the stack when written out.
// `too_deep` (may be null) tells which.
nlohmann::json ParseJson(std::string_view text, bool* too_deep = nullptr);

// Returns the JSON objects and arrays in an answer, in order, whatever surrounds them: prose,
// Markdown fences. Accepts comments and commas before a closing bracket. Nested values are not
// listed separately; bare numbers and strings are not JSON here.
std::vector<nlohmann::json> JsonInText(std::string_view text);

}  // namespace simwright::llm
