#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/variant_choice.h"
#include "physics_params/wordnet.h"

namespace simwright::physics_params {

struct Resolution {
  const Category* category = nullptr;  // null: no category is near enough
  bool exact = false;                  // the name itself is in the base
  std::string sentence;                // how the name was resolved
  std::vector<std::string> closest;    // names to suggest, nearest first, if none was found
  int steps = 0;                       // up WordNet's taxonomy, 0 for other rules and synonyms
  std::string material = "";           // the base's material that the name states; may be empty
};

// The steps up WordNet's taxonomy beyond which a row is too far from a name: the most accurate
// limit on the tuning half of tests/physics_params/measured/names.txt (docs/physics.md).
inline constexpr int kMostSteps = 2;

// Resolves `name` to a category by the first of these rules that gives one:
//   the name itself, its singular, its words joined or split ("coffeetable");
//   "toy" for a name that says so ("toy truck" is not a truck);
//   a row that is in WordNet a synonym of the name or a hypernym up to `most_steps` up ("skillet"
//   is a synonym of "frying pan", a "loveseat" is a sofa); siblings such as duck and chicken never
//   match (docs/physics.md); the same for its head: its last words ("red coffee mug"), or the words
//   before "of" or "with"
//   ("bottle of wine"), unless the whole name is a word of its own ("hot plate" is not a plate).
// A material before the last word ("plastic banana") leads to a row or variant of that material; a
// solid object that is not made of it is refused ("foam die"). A box or can of a food is a food box
// or a tin can. A last word whose row is not its first sense in WordNet is refused behind another
// noun ("air quality monitor" is no screen).
// Accepts the numbers ("chair_01") and capitals ("CoffeeMug") of file names. If `wordnet` is null,
// its rules are skipped. Never throws for an unknown name.
Resolution ResolveCategory(std::string_view name, const KnowledgeBase& base, const WordNet* wordnet,
                           int most_steps = kMostSteps);

// Resolves with the shipped base and the installed WordNet. Throws core::Error, which names the
// three closest categories and "object", if there is none.
Resolution RequireCategory(std::string_view name);

// Returns the resolved row with the variant that `choice` or, where it has no material, the name
// states. Throws core::Error as ChosenVariant does. The resolution has a category.
Category ChosenRow(const Resolution& resolution, const VariantChoice& choice,
                   const KnowledgeBase& base);

// Reports how a name was resolved: nothing if exact, a note if it was taken for another name, a
// warning if nothing was near and "object" stands in.
core::Findings ResolutionFindings(const Resolution& resolution, const std::string& place);

}  // namespace simwright::physics_params
