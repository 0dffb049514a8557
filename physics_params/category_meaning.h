#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "physics_params/knowledge_base.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

struct MeaningMatch {
  const Category* category = nullptr;
  int steps = 0;    // 0: a synonym; n: the category lies n steps above the name in WordNet
  std::string via;  // the words of the synsets in between, "piece of furniture, table"
};

// Returns the row that is a synonym of `name`, or its nearest hypernym, at most `most_steps` up.
// Uses the name's first sense, and its first artifact and food senses unless the first is an animal
// ("dog" is not the sausage). Returns nothing for a name that WordNet does not have, and for one
// whose nearest rows are siblings.
std::optional<MeaningMatch> MatchByMeaning(std::string_view name, const KnowledgeBase& base,
                                           const WordNet& wordnet, int most_steps);

// Returns true if a row means a sense of its name that is not WordNet's first, as "monitor" means
// the screen.
bool IsRareSense(const Category& category);

// Returns true if one of the name's senses is food.
bool IsFood(std::string_view name, const WordNet& wordnet);

// Returns rows to suggest, by Wu and Palmer's similarity, nearest first; none below 0.6.
std::vector<const Category*> NearestByMeaning(std::string_view name, const KnowledgeBase& base,
                                              const WordNet& wordnet);

}  // namespace simwright::physics_params
