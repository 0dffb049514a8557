#include "tasks/language/answer_text.h"

#include <algorithm>
#include <array>

namespace simwright::tasks {
namespace {

constexpr std::size_t kMostRead = 1u << 20;  // bytes; fifty tasks need about a tenth of it
constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// Returns the length of the UTF-8 character at the start of `text`; 0 if it is invalid.
std::size_t CharacterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80    ? 1
                             : first >= 0xF5 ? 0
                             : first >= 0xF0 ? 4
                             : first >= 0xE0 ? 3
                             : first >= 0xC2 ? 2
                                             : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  // The encoding is overlong, a surrogate, or beyond the last code point.
  if (length == 3 && ((first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) > 0x9F))) {
    return 0;
  }
  if (length == 4 && ((first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) > 0x8F))) {
    return 0;
  }
  return length;
}

bool IsWordByte(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}

// Removes the marks `open` and `close` if both are present at the ends.
bool Strip(std::string_view open, std::string_view close, std::string_view* text) {
  if (text->size() < open.size() + close.size()) return false;
  if (!text->starts_with(open) || !text->ends_with(close)) return false;
  text->remove_prefix(open.size());
  text->remove_suffix(close.size());
  return true;
}

}  // namespace

std::string PlainAnswer(std::string_view answer, core::Findings* findings) {
  if (answer.size() > kMostRead) {
    findings->push_back({"answer-cut", core::Severity::kWarning, "",
                         "only the first MiB of the answer is read",
                         static_cast<double>(answer.size())});
    answer = answer.substr(0, kMostRead);
  }
  if (answer.starts_with("\xEF\xBB\xBF")) answer.remove_prefix(3);
  std::string plain;
  plain.reserve(answer.size());
  while (!answer.empty()) {
    const std::size_t length = CharacterLength(answer);
    const char first = answer[0];
    if (length == 0) {
      plain += kReplacement;
    } else if (first == '\r') {
      if (answer.size() < 2 || answer[1] != '\n') plain += '\n';
    } else if (first != '\0') {
      plain += answer.substr(0, length);
    }
    answer.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return plain;
}

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n\v\f";
  constexpr std::string_view kWide = "\u3000";
  for (;;) {
    const std::size_t first = text.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return {};
    text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
    if (text.starts_with(kWide)) {
      text.remove_prefix(kWide.size());
    } else if (text.ends_with(kWide)) {
      text.remove_suffix(kWide.size());
    } else {
      return text;
    }
  }
}

std::string Unquoted(std::string_view text) {
  constexpr std::array<std::array<std::string_view, 2>, 12> kMarks = {{{"**", "**"},
                                                                       {"__", "__"},
                                                                       {"*", "*"},
                                                                       {"`", "`"},
                                                                       {"\"", "\""},
                                                                       {"'", "'"},
                                                                       {"\u201C", "\u201D"},
                                                                       {"\u201E", "\u201C"},
                                                                       {"\u2018", "\u2019"},
                                                                       {"\u00AB", "\u00BB"},
                                                                       {"\u300C", "\u300D"},
                                                                       {"\u300E", "\u300F"}}};
  text = Trimmed(text);
  for (bool again = true; again;) {
    again = false;
    for (const auto& [open, close] : kMarks) again = Strip(open, close, &text) || again;
    for (const auto& [open, close] : kMarks) {  // "Open the door". as a whole sentence
      std::string_view inner = text;
      if (inner.ends_with('.') && (inner.remove_suffix(1), Strip(open, close, &inner))) {
        text = inner;
        again = true;
      }
    }
    text = Trimmed(text);
  }
  return std::string(text);
}

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::vector<std::string> LinesOf(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return lines;
}

int Indentation(std::string_view line) {
  int column = 0;
  for (const char c : line) {
    if (c == '\t') {
      column = (column / 8 + 1) * 8;
    } else if (c == ' ') {
      ++column;
    } else {
      break;
    }
  }
  return column;
}

bool Calls(std::string_view text, std::string_view name) {
  for (std::size_t at = text.find(name); at != std::string_view::npos;
       at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    const bool begins = at == 0 || !(IsWordByte(text[at - 1]) || text[at - 1] == '.');
    const bool defined = at >= 4 && text.substr(at - 4, 4) == "def ";
    if (begins && !defined && end < text.size() && text[end] == '(') return true;
  }
  return false;
}

}  // namespace simwright::tasks
