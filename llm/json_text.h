#pragma once

#include <string_view>
#include <vector>

#include "core/json.h"

namespace simwright::llm {

// Returns the JSON objects and arrays in an answer, in order, whatever surrounds them: prose,
// Markdown fences. Accepts comments and commas before a closing bracket. Nested values are not
// listed separately; bare numbers and strings are not JSON here.
std::vector<core::Json> JsonInText(std::string_view text);

}  // namespace simwright::llm
