#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "physics_params/knowledge_base.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

struct MeaningMatch {
  const Category* category = nullptr;
  int steps = 0;  // 0: a synonym; n: the category lies n steps above the name in WordNet
};

// The row that means the same as `name`, or the nearest one of which it is a kind, at most three
// steps up. The name's first sense counts, and its first artifact and food senses unless the first
// is an animal ("dog" is no sausage). None for a name WordNet does not know, and for one whose
// nearest rows are siblings.
std::optional<MeaningMatch> MatchByMeaning(std::string_view name, const KnowledgeBase& base,
                                           const WordNet& wordnet);

// Rows to suggest, by Wu and Palmer's similarity, the nearest first; none below 0.6.
std::vector<const Category*> NearestByMeaning(std::string_view name, const KnowledgeBase& base,
                                              const WordNet& wordnet);

}  // namespace simwright::physics_params
