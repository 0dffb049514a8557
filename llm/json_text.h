#pragma once

#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace simwright::llm {

// The value of `text`, discarded (is_discarded()) where it is not JSON or nested deeper than 64
// levels: what is deeper is nobody's answer, and writing it out again would exhaust the stack.
// `too_deep` (may be null) says which.
nlohmann::json ParseJson(std::string_view text, bool* too_deep = nullptr);

// The JSON objects and arrays of an answer, in order, whatever stands around them: prose, Markdown
// fences. Comments and commas before a closing bracket are forgiven. What an object or array holds
// is not listed again. Numbers alone and texts are no JSON here.
std::vector<nlohmann::json> JsonInText(std::string_view text);

}  // namespace simwright::llm
