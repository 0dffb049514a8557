#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/finding.h"

namespace simwright::core {

// "note", "warning" or "error", as the terminal and --json say it.
const char* SeverityName(Severity severity);

// `text` in at most `most` bytes, whole characters of UTF-8, with "..." where it was cut.
std::string Bounded(std::string_view text, std::size_t most);

// `text` broken at blanks into lines of at most `width` characters, the second and later ones
// indented by two; one line where `width` is 0.
std::string Wrapped(std::string_view text, std::size_t width);

// How every command prints a finding: "SEVERITY: PLACE: SENTENCE (REMEDY) [CODE]", bounded to 600
// bytes a part and wrapped to `width`, with a line break at the end. Control characters become
// blanks.
std::string FindingText(const Finding& finding, std::size_t width);

// A length (m) in a sentence: "0.81 mm", of three digits.
std::string Millimetres(double metres);

// An error as a finding of severity kError, code "error": its place, fault and remedy.
Finding FindingOf(const Error& error);

}  // namespace simwright::core
