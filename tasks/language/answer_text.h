#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"

namespace simwright::tasks {

// An answer as lines can be read from it: UTF-8 (what is none becomes U+FFFD), line breaks "\n",
// no byte order mark and no zero bytes, at most its first MiB ("answer-cut").
std::string PlainAnswer(std::string_view answer, core::Findings* findings);

// Without blanks at both ends; also without the ideographic space.
std::string_view Trimmed(std::string_view text);

// Without blanks, Markdown's emphasis and quotes around it, `"Open the door".` -> Open the door.
std::string Unquoted(std::string_view text);

// ASCII letters in lower case.
std::string Lower(std::string_view text);

std::vector<std::string> LinesOf(std::string_view text);

// Columns of blanks that `line` begins with; a tab goes to the next multiple of 8.
int Indentation(std::string_view line);

// True where the whole word `name` stands in `text` and a parenthesis behind it.
bool Calls(std::string_view text, std::string_view name);

}  // namespace simwright::tasks
