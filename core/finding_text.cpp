#include "core/finding_text.h"

#include <algorithm>
#include <cstdio>

namespace simwright::core {
namespace {

constexpr std::size_t kLongestPart = 600;  // bytes; longer text is a listing and not a sentence

std::string FindingLine(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return line;
}

bool Continues(char c) {
  return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

std::size_t Characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !Continues(c); }));
}

// Returns the position of the " (" of core::Error's "(REMEDY)", which ends the message and may
// contain brackets itself; npos if there is none.
std::size_t RemedyAt(std::string_view message) {
  if (!message.ends_with(')')) return std::string_view::npos;
  int open = 0;
  for (std::size_t i = message.size(); i-- > 0;) {
    open += (message[i] == ')') - (message[i] == '(');
    if (open == 0) return i > 0 && message[i - 1] == ' ' ? i - 1 : std::string_view::npos;
  }
  return std::string_view::npos;
}

}  // namespace

const char* SeverityName(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kWarning:
      return "warning";
    default:
      return "note";
  }
}

std::string Truncated(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t end = most > 3 ? most - 3 : 0;
  while (end > 0 && Continues(text[end])) --end;
  return std::string(text.substr(0, end)) + "...";
}

std::string Wrapped(std::string_view text, std::size_t width) {
  if (width == 0) return std::string(text);
  constexpr std::string_view kIndent = "  ";
  std::string lines;
  std::size_t column = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t size = Characters(word);
    if (column > kIndent.size() && column + 1 + size > width) {
      lines += '\n';
      lines += kIndent;
      column = kIndent.size();
    } else if (!lines.empty()) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += size;
  }
  return lines;
}

std::string FindingText(const Finding& finding, std::size_t width) {
  std::string line = SeverityName(finding.severity);
  const auto part = [](const std::string& text) {
    return FindingLine(Truncated(text, kLongestPart));
  };
  if (!finding.place.empty()) line += ": " + part(finding.place);
  line += ": " + part(finding.sentence);
  if (!finding.remedy.empty()) line += " (" + part(finding.remedy) + ")";
  if (!finding.code.empty() && finding.code != "error") line += " [" + finding.code + "]";
  return Wrapped(line, width) + "\n";
}

std::string Millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g mm", 1e3 * metres);
  return text;
}

Finding FindingOf(const Error& error) {
  Finding finding{"error", Severity::kError, FindingLine(error.where()), error.what()};
  std::string& sentence = finding.sentence;
  if (!finding.place.empty() && sentence.starts_with(finding.place + ": ")) {
    sentence.erase(0, finding.place.size() + 2);
  }
  const std::size_t remedy = RemedyAt(sentence);
  if (remedy == std::string::npos) return finding;
  finding.remedy = sentence.substr(remedy + 2, sentence.size() - remedy - 3);
  sentence.erase(remedy);
  return finding;
}

}  // namespace simwright::core
