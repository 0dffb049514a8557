#include "tasks/task_names.h"

#include <algorithm>
#include <cstdint>

namespace simwright::tasks {
namespace {

constexpr std::size_t kLongestTaskName = 64;  // bytes; with a suffix and an extension far below 255

bool IsAsciiLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool IsNameDigit(char c) {
  return c >= '0' && c <= '9';
}

// Returns the character at the start of `text` and its length in bytes; length 0 if it is not valid
// UTF-8.
std::uint32_t FirstCharacter(std::string_view text, std::size_t* length) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  *length = first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
  if (*length == 0 || *length > text.size()) return *length = 0;
  if (*length == 1) return first;
  std::uint32_t character = first & (0xFFu >> (*length + 1));
  for (std::size_t i = 1; i < *length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return *length = 0;
    character = character << 6 | (byte(i) & 0x3Fu);
  }
  return character;
}

// Returns false for signs, blanks, control characters, direction marks and private characters
// outside ASCII.
bool IsForeignLetter(std::uint32_t c) {
  if (c < 0xAA || c == 0xD7 || c == 0xF7) return false;
  if (c < 0xC0) return c == 0xAA || c == 0xB5 || c == 0xBA;
  const bool sign = (c >= 0x2000 && c <= 0x2BFF) || (c >= 0x3000 && c <= 0x3004) ||
                    (c >= 0x3007 && c <= 0x3030) || (c >= 0xD800 && c <= 0xF8FF) ||
                    (c >= 0xFE00 && c <= 0xFE6F) || (c >= 0xFF00 && c <= 0xFF20) || (c >= 0xFFE0) ||
                    c == 0xFEFF || c == 0x061C;
  return !sign;
}

std::string Folded(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

// Returns the start of `text`, at most `bytes` long, cut at a character boundary.
std::string WholeCharacters(const std::string& text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  return text.substr(0, bytes);
}

}  // namespace

std::string SafeName(std::string_view title) {
  std::string name;
  bool gap = false;
  while (!title.empty()) {
    std::size_t length = 0;
    const std::uint32_t character = FirstCharacter(title, &length);
    const bool ascii = length == 1;
    const bool alone = ascii && (IsAsciiLetter(title[0]) || IsNameDigit(title[0]));
    const bool joint = ascii && (title[0] == '-' || title[0] == '_') && !name.empty();
    const bool stays = alone || joint || (length > 1 && IsForeignLetter(character));
    if (stays) {
      const bool bridge = gap && !joint && !name.empty() && name.back() != '_';
      if (name.size() + (bridge ? 1 : 0) + length > kLongestTaskName) break;
      if (bridge) name += '_';
      name += title.substr(0, length);
    }
    gap = !stays;
    title.remove_prefix(std::max<std::size_t>(length, 1));
  }
  while (!name.empty() && (name.back() == '_' || name.back() == '-')) name.pop_back();
  return name;
}

std::string UniqueName(const std::string& name, std::set<std::string>* taken) {
  std::string unique = name;
  for (int i = 2; !taken->insert(Folded(unique)).second; ++i) {
    const std::string suffix = "_" + std::to_string(i);
    unique = WholeCharacters(name, kLongestTaskName - suffix.size()) + suffix;
  }
  return unique;
}

bool IsAssetName(std::string_view name) {
  return !name.empty() && name.size() <= kLongestTaskName && IsAsciiLetter(name[0]) &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return IsAsciiLetter(c) || IsNameDigit(c) || c == '_' || c == '-';
         });
}

}  // namespace simwright::tasks
