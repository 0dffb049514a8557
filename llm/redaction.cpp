#include "llm/redaction.h"

#include <algorithm>
#include <unordered_set>

namespace simwright::llm {
namespace {

constexpr std::size_t kRun = 12;
constexpr std::string_view kInstead = "[redacted]";

// Marks the characters of `text` that are covered by runs of `window` characters of `secret`.
std::vector<bool> Covered(std::string_view text, std::string_view secret) {
  const std::size_t window = std::min(secret.size(), kRun);
  std::vector<bool> covered(text.size(), false);
  if (window == 0 || text.size() < window) return covered;
  std::unordered_set<std::string_view> runs;
  for (std::size_t i = 0; i + window <= secret.size(); ++i) runs.insert(secret.substr(i, window));
  for (std::size_t i = 0; i + window <= text.size(); ++i) {
    if (runs.contains(text.substr(i, window))) {
      std::fill_n(covered.begin() + static_cast<std::ptrdiff_t>(i), window, true);
    }
  }
  return covered;
}

}  // namespace

std::string Redact(std::string_view text, const std::vector<std::string>& secrets) {
  std::string result(text);
  for (const std::string& secret : secrets) {
    const std::vector<bool> covered = Covered(result, secret);
    if (std::find(covered.begin(), covered.end(), true) == covered.end()) continue;
    std::string cleaned;
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (!covered[i]) {
        cleaned += result[i];
      } else if (i == 0 || !covered[i - 1]) {
        cleaned += kInstead;
      }
    }
    result = std::move(cleaned);
  }
  return result;
}

std::string Shortened(std::string_view text, std::size_t limit) {
  std::string line;
  for (const char c : text.substr(0, limit + 1)) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    line += control ? ' ' : c;
  }
  if (text.size() <= limit) return line;
  std::size_t end = limit;
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xc0) == 0x80) --end;
  return line.substr(0, end) + "...";
}

}  // namespace simwright::llm
