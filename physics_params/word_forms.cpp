#include "physics_params/word_forms.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {
namespace {

template <size_t N>
bool Among(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool IsWordDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool IsLower(char c) {
  return std::islower(static_cast<unsigned char>(c)) != 0;
}

bool IsUpper(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}

// Splits "CoffeeMug01" into "Coffee Mug "; dots and numbers separate words.
std::string SplitWords(std::string_view name) {
  std::string parted;
  for (size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (i > 0 && IsUpper(c) && IsLower(name[i - 1])) parted += ' ';
    parted += IsWordDigit(c) || c == '.' ? ' ' : c;
  }
  return parted;
}

}  // namespace

std::string PlainName(std::string_view name) {
  const std::string parted = NormaliseName(SplitWords(name));
  // "v2" leaves a "v", "mug_a" an "a".
  std::vector<std::string> words = WordsOf(parted);
  while (words.size() > 1 && words.back().size() == 1) words.pop_back();
  return words.empty() ? NormaliseName(name) : Joined(words, 0, words.size(), " ");
}

std::vector<std::string> WordsOf(std::string_view name) {
  std::vector<std::string> words;
  while (!name.empty()) {
    const size_t end = std::min(name.find(' '), name.size());
    if (end > 0) words.emplace_back(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return words;
}

std::string Joined(const std::vector<std::string>& words, size_t first, size_t last,
                   std::string_view between) {
  std::string joined;
  for (size_t i = first; i < last; ++i) {
    if (i > first) joined += between;
    joined += words[i];
  }
  return joined;
}

std::string PhraseHead(std::string_view name) {
  static constexpr std::array<std::string_view, 7> kPrepositions = {"of", "with", "without", "for",
                                                                    "in", "on",   "from"};
  // Words for a part or a quantity: neither is the object that it is named after.
  static constexpr std::array<std::string_view, 13> kPartsAndAmounts = {
      "piece", "slice", "half", "part",  "chunk", "lump", "bit",
      "set",   "stack", "pile", "bunch", "heap",  "group"};
  const std::vector<std::string> words = WordsOf(name);
  for (size_t i = 1; i + 1 < words.size(); ++i) {
    if (!Among(words[i], kPrepositions)) continue;
    if (words[i] == "of" && Among(words[i - 1], kPartsAndAmounts)) return "";
    if (words[i] == "of" && words[i - 1] == "pair") return Joined(words, i + 1, words.size(), " ");
    return Joined(words, 0, i, " ");
  }
  return std::string(name);
}

bool IsSmallCopy(std::string_view name) {
  static constexpr std::array<std::string_view, 9> kSmall = {
      "toy", "toys", "miniature", "plush", "plushie", "lego", "playmobil", "dollhouse", "model"};
  const std::vector<std::string> words = WordsOf(name);
  return words.size() > 1 && std::any_of(words.begin(), words.end(), [](const std::string& word) {
           return Among(word, kSmall);
         });
}

}  // namespace simwright::physics_params
