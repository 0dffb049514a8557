#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

struct Resolution {
  const Category* category = nullptr;  // null: no kind is near enough
  bool exact = false;                  // the name itself is in the base
  std::string sentence;                // how the name led to the category
  std::vector<std::string> closest;    // names to suggest, nearest first, where none was found
};

// The category meant by `name`, by the first of these that gives one:
//   the name itself, its singular, its words written together or apart ("coffeetable");
//   "toy" for what is said to be one ("toy truck" is none of the trucks);
//   a row whose meaning in WordNet is that of the name or, up to three steps, above it ("skillet"
//   is a synonym of "frying pan", a "loveseat" is a sofa); siblings such as duck and chicken are
//   never taken for each other (docs/physics.md);
//   the same of its head: its last words ("red coffee mug"), or what stands before "of" or "with"
//   ("bottle of wine"), where the whole is no word of its own ("hot plate" is no plate).
// Numbers ("chair_01") and capitals ("CoffeeMug") of file names are understood. `wordnet` may be
// null: its steps are left out. Never throws for an unknown name.
Resolution ResolveCategory(std::string_view name, const KnowledgeBase& base,
                           const WordNet* wordnet);

// As above, with the shipped base and the installed WordNet. Throws core::Error, which names the
// three closest kinds and "object", when there is none.
Resolution RequireCategory(std::string_view name);

// What a person should know of how a name was understood: nothing where it is exact, a note where
// it was taken for another, a warning where nothing was near and "object" stands for it.
core::Findings ResolutionFindings(const Resolution& resolution, const std::string& place);

}  // namespace simwright::physics_params
