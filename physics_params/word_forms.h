#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::physics_params {

// The words of a thing's or a file's name: lower case, without numbers: "CoffeeMug_01" gives
// "coffee mug".
std::string PlainName(std::string_view name);

// Words of a normalised name.
std::vector<std::string> WordsOf(std::string_view name);
std::string Joined(const std::vector<std::string>& words, size_t first, size_t last,
                   std::string_view between);

// What a name with "of", "with", "for" ... is about: "bottle of wine" gives "bottle", "pair of
// scissors" gives "scissors", "slice of pizza" nothing (a part is not the whole). The name itself
// where it has no such word.
std::string WithoutComplement(std::string_view name);

// True where a word says that the thing is a small copy: "toy truck", "miniature castle".
bool IsSmallCopy(std::string_view name);

}  // namespace simwright::physics_params
