#pragma once

#include <optional>
#include <string>
#include <vector>

namespace simwright::scene {

// Returns a scene type in words: "pantry shelf", "breakfast table for six"; for an unknown type its
// name with blanks.
std::string WordsOfSceneType(const std::string& type);

// Returns the prompt of Prompt::Text for a model of several scene types, which read the type at its
// start: "A pantry shelf with two apples." for "A scene with two apples.", and "A pantry shelf."
// for the empty prompt.
std::string PromptOfSceneType(const std::string& prompt, const std::string& type);

// Looks for one of `types` in a request in English ("dim sum table", "pantry") and replaces it by
// "scene". The longest wording decides, then the order of `types`. Returns the type; nothing if
// there is none.
std::optional<std::string> TakeSceneType(const std::vector<std::string>& types, std::string* text);

}  // namespace simwright::scene
