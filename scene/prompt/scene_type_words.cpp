#include "scene/prompt/scene_type_words.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace simwright::scene {
namespace {

constexpr char kAnyScene[] = "A scene";

// A scene type with its wordings; the first is the one that models read.
struct TypeWording {
  const char* type;
  std::array<const char*, 4> words;
};

constexpr TypeWording kWordings[] = {
    {"breakfast_high", {"breakfast table for six", "large breakfast table", "breakfast table"}},
    {"breakfast_low", {"breakfast table for two", "small breakfast table", "breakfast table"}},
    {"dimsum", {"dimsum table", "dim sum table", "dim-sum table", "dimsum scene"}},
    {"living_room_shelf", {"living room shelf", "living-room shelf", "toy shelf"}},
    {"pantry_shelf", {"pantry shelf", "pantry", "larder shelf", "larder"}},
    {"restaurant_high", {"full restaurant", "busy restaurant", "restaurant"}},
    {"restaurant_low", {"quiet restaurant", "restaurant"}},
};

std::vector<std::string> WordingsOf(const std::string& type) {
  for (const TypeWording& one : kWordings) {
    if (one.type != type) continue;
    std::vector<std::string> words;
    for (const char* const some : one.words) {
      if (some != nullptr) words.emplace_back(some);
    }
    return words;
  }
  std::string words = type;
  std::replace(words.begin(), words.end(), '_', ' ');
  return {words};
}

std::string Lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Returns the first position of whole words in a text; npos without them.
size_t FindWords(const std::string& text, const std::string& words) {
  const auto is_letter = [&](size_t i) {
    return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]));
  };
  for (size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) {
    if ((at == 0 || !is_letter(at - 1)) && !is_letter(at + words.size())) return at;
  }
  return std::string::npos;
}

}  // namespace

std::string WordsOfSceneType(const std::string& type) {
  return WordingsOf(type).front();
}

std::string PromptOfSceneType(const std::string& prompt, const std::string& type) {
  const std::string start = "A " + WordsOfSceneType(type);
  if (prompt.empty()) return start + ".";
  if (prompt.starts_with(kAnyScene)) return start + prompt.substr(sizeof(kAnyScene) - 1);
  return start + ". " + prompt;
}

std::optional<std::string> TakeSceneType(const std::vector<std::string>& types, std::string* text) {
  const std::string lower = Lower(*text);
  std::string best_words;
  std::optional<std::string> best;
  size_t best_at = 0;
  for (const std::string& type : types) {
    for (const std::string& words : WordingsOf(type)) {
      const size_t at = FindWords(lower, words);
      if (at == std::string::npos || words.size() <= best_words.size()) continue;
      best = type;
      best_words = words;
      best_at = at;
    }
  }
  if (best) text->replace(best_at, best_words.size(), "scene");
  return best;
}

}  // namespace simwright::scene
