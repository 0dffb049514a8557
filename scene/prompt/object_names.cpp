#include "scene/prompt/object_names.h"

#include <algorithm>
#include <array>

#include "scene/dataset/vocabulary.h"

namespace simwright::scene {
namespace {

// Categories whose name is not simply their words, and further words for the same name.
struct NameException {
  const char* category;
  const char* name;
  std::array<const char*, 2> others;
};
constexpr std::array<NameException, 3> kNameExceptions = {{
    {"board_game_large", "large board game", {"big board game", ""}},
    {"board_game_small", "small board game", {"little board game", ""}},
    {"toast", "slice of toast", {"piece of toast", "toast slice"}},
}};

constexpr std::array<const char*, 21> kNumberWords = {
    "zero",     "one",     "two",     "three",     "four",     "five",     "six",
    "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",   "thirteen",
    "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen", "twenty"};
constexpr std::array<const char*, 21> kOrdinalWords = {
    "",           "first",     "second",    "third",       "fourth",     "fifth",      "sixth",
    "seventh",    "eighth",    "ninth",     "tenth",       "eleventh",   "twelfth",    "thirteenth",
    "fourteenth", "fifteenth", "sixteenth", "seventeenth", "eighteenth", "nineteenth", "twentieth"};

bool EndsWithAny(const std::string& word, std::initializer_list<const char*> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](const char* ending) { return word.ends_with(ending); });
}

std::string PluralOfWord(const std::string& word) {
  const auto without = [&](size_t letters) { return word.substr(0, word.size() - letters); };
  const bool after_consonant =
      word.size() >= 2 && std::string("aeiou").find(word[word.size() - 2]) == std::string::npos;
  if (EndsWithAny(word, {"knife", "wife", "life"})) return without(2) + "ves";
  if (EndsWithAny(word, {"shelf", "loaf", "leaf", "half"})) return without(1) + "ves";
  if (EndsWithAny(word, {"man"})) return without(2) + "en";
  if (EndsWithAny(word, {"mouse"})) return without(5) + "mice";
  if (EndsWithAny(word, {"potato", "tomato"})) return word + "es";
  if (EndsWithAny(word, {"s", "x", "z", "ch", "sh"})) return word + "es";
  if (word.ends_with("y") && after_consonant) return without(1) + "ies";
  return word + "s";
}

std::string WordsOf(std::string category) {
  const size_t underscore = category.rfind('_');
  if (underscore != std::string::npos && underscore > 0 && underscore + 1 < category.size() &&
      category.find_first_not_of("0123456789", underscore + 1) == std::string::npos) {
    category.resize(underscore);
  }
  std::replace(category.begin(), category.end(), '_', ' ');
  return category;
}

void AddSpellings(const std::string& spelling, std::vector<std::string>* spellings) {
  for (const std::string& one : {spelling, PluralOf(spelling)}) {
    if (std::find(spellings->begin(), spellings->end(), one) == spellings->end()) {
      spellings->push_back(one);
    }
  }
}

}  // namespace

std::string NameOfCategory(const std::string& category) {
  const std::string words = WordsOf(category);
  for (const NameException& exception : kNameExceptions) {
    if (words == WordsOf(exception.category)) return exception.name;
  }
  return words;
}

std::vector<std::string> NamesOfVocabulary(const Vocabulary& vocabulary) {
  std::vector<std::string> names;
  for (size_t i = 0; i < vocabulary.categories.size(); ++i) {
    if (!vocabulary.welded[i]) names.push_back(NameOfCategory(vocabulary.categories[i]));
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string PluralOf(const std::string& name) {
  const size_t of = name.find(" of ");
  if (of != std::string::npos) return PluralOf(name.substr(0, of)) + name.substr(of);
  const size_t blank = name.rfind(' ');
  if (blank == std::string::npos) return PluralOfWord(name);
  return name.substr(0, blank + 1) + PluralOfWord(name.substr(blank + 1));
}

std::string WithArticle(const std::string& name) {
  for (const char* consonant : {"uten", "uni", "use", "uku", "eu", "one"}) {
    if (name.starts_with(consonant)) return "a " + name;
  }
  const bool vowel = !name.empty() && std::string("aeiou").find(name[0]) != std::string::npos;
  return (vowel || name.starts_with("hour") ? "an " : "a ") + name;
}

std::string NumberWord(int number) {
  const auto index = static_cast<size_t>(number);
  return index < kNumberWords.size() ? kNumberWords[index] : std::to_string(number);
}

std::string CountedName(int count, const std::string& name) {
  if (count == 0) return "no " + PluralOf(name);
  return count == 1 ? WithArticle(name) : NumberWord(count) + " " + PluralOf(name);
}

std::string OrdinalWord(int ordinal) {
  const auto index = static_cast<size_t>(ordinal);
  if (index < kOrdinalWords.size()) return kOrdinalWords[index];
  const int tens = ordinal / 10 % 10, ones = ordinal % 10;
  const char* const ending = tens == 1   ? "th"
                             : ones == 1 ? "st"
                             : ones == 2 ? "nd"
                             : ones == 3 ? "rd"
                                         : "th";
  return std::to_string(ordinal) + ending;
}

std::vector<std::string> SpellingsOf(const std::string& name) {
  std::vector<std::string> spellings;
  AddSpellings(name, &spellings);
  for (const NameException& exception : kNameExceptions) {
    if (name != exception.name) continue;
    AddSpellings(WordsOf(exception.category), &spellings);
    for (const char* other : exception.others) {
      if (*other != '\0') AddSpellings(other, &spellings);
    }
  }
  return spellings;
}

}  // namespace simwright::scene
