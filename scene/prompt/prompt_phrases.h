#pragma once

#include <string>
#include <unordered_map>
#include <unordered_set>

#include "scene/prompt/prompt_items.h"

namespace simwright::scene {

inline constexpr size_t kLongestPhrase = 6;  // words

// Returns the fixed phrases by their words with single blanks: relations, tiers, quantities,
// function words.
const std::unordered_map<std::string, PromptItem>& PromptPhrases();

// Returns the values of number words: "zero" to "nineteen", "twenty" ... "ninety".
const std::unordered_map<std::string, int>& NumberWords();

// Returns words that name no object: function words, verbs of requests, places of scenes.
bool IsFillerWord(const std::string& word);

}  // namespace simwright::scene
