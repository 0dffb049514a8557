#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "scene/prompt/prompt.h"

namespace simwright::physics_params {
class WordNet;
}

namespace simwright::scene {

struct Vocabulary;

inline constexpr int kMostPromptWords = 2000;

struct PromptReading {
  Prompt prompt;
  std::string text;  // prompt.Text(), which models read
  // The names that are mentioned by reference only, as in "next to the bowl". A subset of
  // prompt.names: a new scene gets these objects, too; a completion looks for them in its scene.
  std::vector<std::string> referred = {};
  // Notes on readings that were chosen (numbers for "several", synonyms, ignored words) and
  // warnings about objects that are not known and statements that are not understood.
  core::Findings findings;
};

// Reads a request in English. Understood are, in any order and number of sentences:
//   objects     `known_names` (of NameOfCategory) in singular or plural, longest first; their last
//               or first words alone; and with WordNet synonyms, kinds and genera up to two steps
//               away. Words before a name that are no name ("red", "soup bowl") are ignored.
//   counts      words and digits, "a dozen", "a pair of"; "no", "without"; "several", "lots of",
//               for which a number is chosen. A number of "objects" is the total.
//   others      "and some other objects", "and more"
//   statements  the relations of Relation in common wordings, shelf tiers, ordinals; "the apple" is
//               an object that was named before, or one that is thereby asked for
// The result of Prompt::Text is read back as the same prompt. A blank text gives the empty prompt.
// Without `wordnet` (null) synonyms are not understood. Throws core::Error for a text that is too
// long (kMostPromptWords), is not UTF-8 or has control characters, for contradictions, naming both
// parts, and for a text in which nothing is understood, naming the nearest known names.
PromptReading ReadPrompt(std::string_view text, const std::vector<std::string>& known_names,
                         const physics_params::WordNet* wordnet);

// The same for the free categories of a vocabulary. Warns about a prompt with more objects than its
// scenes have entries.
PromptReading ReadPrompt(std::string_view text, const Vocabulary& vocabulary,
                         const physics_params::WordNet* wordnet);

}  // namespace simwright::scene
