#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::physics_params {

// Returns the words of an object's or a file's name in lower case, without numbers: "CoffeeMug_01"
// gives "coffee mug".
std::string PlainName(std::string_view name);

// Splits a normalised name into words.
std::vector<std::string> WordsOf(std::string_view name);
std::string Joined(const std::vector<std::string>& words, size_t first, size_t last,
                   std::string_view between);

// Returns the head of a name with "of", "with", "for" ...: "bottle of wine" gives "bottle", "pair
// of scissors" gives "scissors", "slice of pizza" nothing (a part is not the whole). Returns the
// name itself if it has no such word.
std::string PhraseHead(std::string_view name);

// Returns true if a word marks a small copy: "toy truck", "miniature castle".
bool IsSmallCopy(std::string_view name);

}  // namespace simwright::physics_params
