#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::scene {

// A word of a prompt in lower case, or a mark: "," or ".".
struct PromptWord {
  std::string text;

  bool IsMark() const { return text == "," || text == "."; }
};

// Splits a text into words and marks. Underscores and hyphens separate words, numeric suffixes of
// categories ("apple_2") and possessive endings are dropped, "don't" becomes "not"; colons and
// brackets are commas, other marks that end a sentence are full stops. Throws core::Error for more
// than kMostPromptWords words, a word of more than 100 bytes, control characters, or a text that is
// not UTF-8.
std::vector<PromptWord> SplitPrompt(std::string_view text);

// Returns the words first .. last - 1 with single blanks.
std::string JoinWords(const std::vector<PromptWord>& words, size_t first, size_t last);

}  // namespace simwright::scene
