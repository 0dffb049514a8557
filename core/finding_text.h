#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/finding.h"

namespace simwright::core {

// Returns "note", "warning" or "error", as printed on the terminal and in --json.
const char* SeverityName(Severity severity);

// Truncates `text` to at most `most` bytes at a UTF-8 character boundary, with "..." where it was
// cut.
std::string Truncated(std::string_view text, std::size_t most);

// Wraps `text` at blanks into lines of at most `width` characters, with lines after the first
// indented by two. Returns one line if `width` is 0.
std::string Wrapped(std::string_view text, std::size_t width);

// Formats a finding as every command prints it: "SEVERITY: PLACE: SENTENCE (REMEDY) [CODE]", with
// each part limited to 600 bytes, wrapped to `width` and ended by a line break. Control characters
// become blanks.
std::string FindingText(const Finding& finding, std::size_t width);

// Formats a length (m) in millimetres with three digits: "0.81 mm".
std::string Millimetres(double metres);

// Converts an error to a finding of severity kError and code "error", with its place, fault and
// remedy.
Finding FindingOf(const Error& error);

}  // namespace simwright::core
