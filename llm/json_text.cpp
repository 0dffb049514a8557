#include "llm/json_text.h"

#include <string>

#include <nlohmann/json.hpp>

namespace simwright::llm {
namespace {

using TextJson = nlohmann::json;

constexpr int kDeepest = 64;        // levels
constexpr int kMostFailures = 200;  // brackets that begin no JSON, so that time stays linear

TextJson ParseBounded(std::string_view text, bool comments, bool* too_deep) {
  const auto bounded = [too_deep](int depth, TextJson::parse_event_t, TextJson&) {
    *too_deep = *too_deep || depth >= kDeepest;
    return depth < kDeepest;
  };
  TextJson json = TextJson::parse(text, bounded, false, comments);
  return *too_deep ? TextJson(TextJson::value_t::discarded) : json;
}

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

TextJson ParseJson(std::string_view text, bool* too_deep) {
  bool deep = false;
  TextJson json = ParseBounded(text, false, &deep);
  if (too_deep != nullptr) *too_deep = deep;
  return json;
}

std::vector<TextJson> JsonInText(std::string_view text) {
  std::vector<TextJson> found;
  int failures = 0;
  for (std::size_t at = text.find_first_of("{["); at != std::string_view::npos;
       at = text.find_first_of("{[", at)) {
    const std::size_t length = BracketedLength(text.substr(at));
    if (length > 0) {
      bool too_deep = false;
      TextJson json = ParseBounded(WithoutTrailingCommas(text.substr(at, length)), true, &too_deep);
      if (!json.is_discarded()) {
        found.push_back(std::move(json));
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
