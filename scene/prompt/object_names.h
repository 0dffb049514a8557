#pragma once

#include <string>
#include <vector>

namespace simwright::scene {

struct Vocabulary;

// Returns the name of a category in prompts: without a numeric suffix and with blanks for
// underscores; "apple" for "apple_2", "tea bottle" for "tea_bottle". A short table holds the
// exceptions: "large board game" for "board_game_large", "slice of toast" for "toast".
std::string NameOfCategory(const std::string& category);

// Returns the names of a vocabulary's free categories, sorted and unique. Furniture has no name.
std::vector<std::string> NamesOfVocabulary(const Vocabulary& vocabulary);

// Returns the English plural of a name: "knives", "serving dishes", "slices of toast".
std::string PluralOf(const std::string& name);

// Returns the name with its indefinite article: "an apple", "a utensil crock".
std::string WithArticle(const std::string& name);

// Returns "zero" to "twenty", digits above. Requires number >= 0.
std::string NumberWord(int number);

// Returns a number of objects in words: "no cups", "a cup", "two cups". Requires count >= 0.
std::string CountedName(int count, const std::string& name);

// Returns "first" to "twentieth", then "21st", "22nd", "111th". Requires ordinal >= 1.
std::string OrdinalWord(int ordinal);

// Returns all spellings under which a reader finds the name: singular, plural, and the words of the
// category itself ("board game small", "toast"), each in lower case with single blanks.
std::vector<std::string> SpellingsOf(const std::string& name);

}  // namespace simwright::scene
