#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"

namespace simwright::tasks {

// Returns an answer as normalized text: valid UTF-8 (invalid bytes become U+FFFD), line breaks
// "\n", no byte order mark, no zero bytes, and at most the first MiB ("answer-cut").
std::string PlainAnswer(std::string_view answer, core::Findings* findings);

// Returns `text` without leading and trailing white space, including the ideographic space.
std::string_view Trimmed(std::string_view text);

// Returns `text` without surrounding white space, Markdown emphasis and quotes: `"Open the door".`
// becomes Open the door.
std::string Unquoted(std::string_view text);

// Returns `text` with ASCII letters in lower case.
std::string Lower(std::string_view text);

std::vector<std::string> LinesOf(std::string_view text);

// Returns the width in columns of the white space that begins `line`; a tab advances to the next
// multiple of 8.
int Indentation(std::string_view line);

// Returns true if `text` holds the whole word `name` followed by a parenthesis.
bool Calls(std::string_view text, std::string_view name);

}  // namespace simwright::tasks
