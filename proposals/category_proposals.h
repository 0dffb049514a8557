#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "llm/chat_model.h"

namespace simwright::proposals {

// A category that is worth an asset, and the words that ask for its picture.
struct CategoryProposal {
  std::string category;  // lower case, at most four words
  std::string prompt;
  std::string source;  // "knowledge base", "WordNet", "language model" or "folder"
  std::string row;     // the knowledge base's row that gives its size and mass; may be empty
  double score = 0.0;  // relevance for the theme, in [0, 1]; 0 unless found offline
};

// Returns the themes with lists of nouns of their own, "kitchen" ...; other themes are ranked by
// WordNet's similarity with their name.
std::vector<std::string> KnownThemes();

// Returns up to `count` categories for a theme without a language model: rows of the knowledge
// base, and WordNet's hyponyms of the theme's nouns that such a row covers. All can be handled by a
// robot's gripper: at most 5 kg, 1 cm to 60 cm long. Rows that are variants of others are left out;
// a row and its hyponyms give at most three. Ordered by relevance, less for each chosen one of the
// same last word or noun of the theme; the same theme gives the same list. `findings` gets
// "theme-unknown" for a theme without a list, and "proposals-fewer" if there are fewer than
// `count`. Throws core::Error for a theme that is no noun that WordNet knows.
std::vector<CategoryProposal> OfflineCategories(const std::string& theme, int count,
                                                core::Findings* findings);

// Returns up to `count` categories that a language model names for a theme, in its order, with its
// prompts. Its answers are data: names are reduced to four words of letters, digits and hyphens,
// prompts to one line of 300 bytes; what cannot be handled, is no name, or repeats another is left
// out with a finding. It is asked up to three times. Throws core::Error if it is not reachable or
// names nothing.
std::vector<CategoryProposal> LanguageModelCategories(const std::string& theme, int count,
                                                      llm::ChatModel* model,
                                                      core::Findings* findings,
                                                      core::Progress* progress);

// Returns a name as a category: lower case, without surrounding blanks and quotes; "" unless it has
// 2 to 40 bytes in one to four words of ASCII letters, digits, hyphens and apostrophes.
std::string SafeCategory(std::string_view name);

// Returns the knowledge base's row that covers a category; "" if none does.
std::string RowOf(const std::string& category);

// Returns the words that ask for a picture of one object.
std::string PromptFor(const std::string& category);
// The negative prompt of all pictures.
inline constexpr const char* kProposalNegativePrompt =
    "several objects, hands, people, text, watermark, cropped, cluttered background, strong shadow";

}  // namespace simwright::proposals
