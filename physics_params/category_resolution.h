#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "physics_params/knowledge_base.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

struct Resolution {
  const Category* category = nullptr;  // null: no kind is near enough
  bool exact = false;                  // the name itself is in the base
  std::string sentence;                // how the name led to the category
  std::vector<std::string> closest;    // names to suggest, nearest first, where none was found
};

// The category meant by `name`: the name itself; its singular; its last words ("red coffee mug"
// -> "coffee mug"); else the nearest kind by WordNet (`wordnet` may be null: that step is left
// out). Never throws for an unknown name.
Resolution ResolveCategory(std::string_view name, const KnowledgeBase& base,
                           const WordNet* wordnet);

// As above, with the shipped base and the installed WordNet. Throws core::Error, which names the
// closest kinds, when there is none.
Resolution RequireCategory(std::string_view name);

}  // namespace simwright::physics_params
