#include "llm/json_text.h"

#include <optional>
#include <string>

namespace simwright::llm {
namespace {

constexpr int kMostFailures = 200;  // brackets that begin no JSON, so that time stays linear

// Returns the length of the bracketed text at the start of `text`, respecting quotes; 0 if
// unclosed.
std::size_t BracketedLength(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
      continue;
    }
    quoted = c == '"';
    if (c == '{' || c == '[') ++depth;
    if ((c == '}' || c == ']') && --depth == 0) return i + 1;
  }
  return 0;
}

std::string WithoutTrailingCommas(std::string_view text) {
  std::string result;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') {
      result += text.substr(i++, 2);
      continue;
    }
    if (c == '"') quoted = !quoted;
    if (!quoted && c == ',') {
      const std::size_t next = text.find_first_not_of(" \t\r\n", i + 1);
      if (next != std::string_view::npos && (text[next] == '}' || text[next] == ']')) continue;
    }
    result += c;
  }
  return result;
}

}  // namespace

std::vector<core::Json> JsonInText(std::string_view text) {
  std::vector<core::Json> found;
  int failures = 0;
  for (std::size_t at = text.find_first_of("{["); at != std::string_view::npos;
       at = text.find_first_of("{[", at)) {
    const std::size_t length = BracketedLength(text.substr(at));
    if (length > 0) {
      std::optional<core::Json> json =
          core::TryParseJson(WithoutTrailingCommas(text.substr(at, length)), true);
      if (json) {
        found.push_back(std::move(*json));
        at += length;
        continue;
      }
    }
    if (++failures == kMostFailures) break;
    ++at;
  }
  return found;
}

}  // namespace simwright::llm
