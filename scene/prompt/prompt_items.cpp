#include "scene/prompt/prompt_items.h"

#include <algorithm>
#include <cstdint>

#include "core/error.h"
#include "scene/prompt/prompt.h"
#include "scene/prompt/prompt_phrases.h"

namespace simwright::scene {
namespace {

using Kind = PromptItemKind;

// Returns the item of the longest fixed phrase that begins at `at`, and the number of its words.
std::pair<const PromptItem*, size_t> PhraseAt(const std::vector<PromptWord>& words, size_t at) {
  const auto& phrases = PromptPhrases();
  for (size_t count = std::min(kLongestPhrase, words.size() - at); count > 0; --count) {
    const auto found = phrases.find(JoinWords(words, at, at + count));
    if (found != phrases.end()) return {&found->second, count};
  }
  return {nullptr, 0};
}

[[noreturn]] void RejectNumber(const std::string& word) {
  throw core::Error("\"" + word + "\" is no number of objects", "",
                    "write a whole number from 0 to " + std::to_string(kMostPromptObjects));
}

// Returns the value of digits, "12" or "1,200"; -1 if the word does not begin with one.
int DigitsValue(const std::string& word) {
  const size_t first = word[0] == '-' ? 1 : 0;
  if (first >= word.size() || word[first] < '0' || word[first] > '9') return -1;
  std::string digits = word;
  const size_t comma = digits.find(',');
  if (comma != std::string::npos && comma <= 3 && digits.size() == comma + 4) {
    digits.erase(comma, 1);
  }
  const bool all_digits = digits.find_first_not_of("0123456789") == std::string::npos;
  if (!all_digits) {
    // "2nd" is an ordinal, "4k" a word.
    const bool letters = digits.find_first_not_of("0123456789.,-") != std::string::npos;
    if (letters && first == 0) return -1;
    RejectNumber(word);
  }
  while (digits.size() > 1 && digits[0] == '0') digits.erase(0, 1);
  if (digits.size() > 6 || std::stoi(digits) > kMostPromptObjects) RejectNumber(word);
  return std::stoi(digits);
}

// Reads a number in words that begins at `at`, "one hundred and twenty": returns its value and the
// number of its words, 0 if there is none.
std::pair<int, size_t> WordsValue(const std::vector<PromptWord>& words, size_t at) {
  std::int64_t value = 0, below_thousand = 0;
  size_t count = 0;
  bool has_ones = false, has_tens = false;
  const auto& numbers = NumberWords();
  for (size_t i = at; i < words.size(); ++i) {
    const std::string& word = words[i].text;
    const auto number = numbers.find(word);
    const bool is_tens = number != numbers.end() && number->second >= 20;
    if (number != numbers.end() && !has_ones && !(is_tens && has_tens) &&
        !(has_tens && number->second > 9)) {
      below_thousand += number->second;
      has_tens = has_tens || is_tens;
      has_ones = !is_tens;
    } else if (word == "hundred" && count > 0 && below_thousand > 0 && below_thousand < 10) {
      below_thousand *= 100;
      has_ones = has_tens = false;
    } else if (word == "thousand" && count > 0 && below_thousand > 0 && value == 0) {
      value = below_thousand * 1000;
      below_thousand = 0;
      has_ones = has_tens = false;
    } else if (word == "and" && count > 0 && i + 1 < words.size() &&
               (words[i - 1].text == "hundred" || words[i - 1].text == "thousand") &&
               numbers.contains(words[i + 1].text)) {
      continue;
    } else {
      break;
    }
    count = i - at + 1;
  }
  if (value + below_thousand > kMostPromptObjects) RejectNumber(JoinWords(words, at, at + count));
  return {static_cast<int>(value + below_thousand), count};
}

// Returns the value of "21st" or "3rd", 0 for other words.
int OrdinalDigits(const std::string& word) {
  if (word.size() < 3 || word.size() > 11) return 0;
  const std::string digits = word.substr(0, word.size() - 2), ending = word.substr(digits.size());
  if (digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  const bool is_ordinal = ending == "st" || ending == "nd" || ending == "rd" || ending == "th";
  return is_ordinal ? std::stoi(digits) : 0;
}

std::pair<PromptItem, size_t> NumberAt(const std::vector<PromptWord>& words, size_t at) {
  PromptItem item;
  item.kind = Kind::kNumber;
  const int ordinal = OrdinalDigits(words[at].text);
  if (ordinal > 0) {
    item.kind = Kind::kOrdinal;
    item.number = ordinal;
    return {item, 1};
  }
  item.number = DigitsValue(words[at].text);
  if (item.number >= 0) return {item, 1};
  const auto [value, count] = WordsValue(words, at);
  item.number = value;
  return {item, count};
}

// Returns the item at `at` with the number of its words. An exact name precedes a fixed phrase of
// the same length, and both precede a related name.
std::pair<PromptItem, size_t> ItemAt(const std::vector<PromptWord>& words, size_t at,
                                     const NameLookup& lookup) {
  PromptItem item;
  if (words[at].IsMark()) {
    item.kind = words[at].text == "," ? Kind::kComma : Kind::kStop;
    return {item, 1};
  }
  const std::optional<NameMatch> exact = lookup.Exact(words, at);
  const auto [phrase, phrase_words] = PhraseAt(words, at);
  const auto named = [&](const NameMatch& match) {
    item.kind = Kind::kName;
    item.match = match;
    return std::pair(item, match.words);
  };
  const auto [number, number_words] = NumberAt(words, at);
  if (exact && exact->words >= std::max(phrase_words, number_words)) return named(*exact);
  if (number_words > 0 && number_words >= phrase_words) return {number, number_words};
  if (phrase != nullptr) return {*phrase, phrase_words};
  if (!IsFillerWord(words[at].text)) {
    const std::optional<NameMatch> related = lookup.Related(words, at);
    // A noun before a name says which one: a fruit bowl is a bowl, no fruit.
    const bool modifies = related && !related->plural && at + related->words < words.size() &&
                          lookup.Exact(words, at + related->words);
    if (related && !modifies) return named(*related);
    item.kind = Kind::kUnknown;
  }
  return {item, 1};
}

}  // namespace

std::vector<PromptItem> FindPromptItems(const std::vector<PromptWord>& words,
                                        const NameLookup& lookup) {
  std::vector<PromptItem> items;
  for (size_t at = 0; at < words.size();) {
    auto [item, count] = ItemAt(words, at, lookup);
    item.words = JoinWords(words, at, at + count);
    items.push_back(std::move(item));
    at += count;
  }
  return items;
}

}  // namespace simwright::scene
