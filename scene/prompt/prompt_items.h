#pragma once

#include <string>
#include <vector>

#include "scene/prompt/name_lookup.h"
#include "scene/prompt/relation.h"

namespace simwright::scene {

enum class PromptItemKind {
  kName,      // a known name
  kTotal,     // "objects"
  kOthers,    // "some other objects"
  kNoOthers,  // "nothing else"
  kNumber,    // "two"
  kVague,     // "several"
  kNone,      // "no", "without"
  kNot,       // "not"
  kArticle,   // "a"
  kThe,       // "the"
  kOneOf,     // "one of the"
  kOrdinal,   // "second"
  kRelation,  // "to the left of"
  kTier,      // "on the top shelf"
  kPronoun,   // "it"
  kIs,        // "is"
  kAre,       // "are"
  kThere,     // "there is": what follows is new
  kAnd,       // "and"
  kOr,        // "or"
  kComma,     //
  kStop,      // a full stop
  kPlace,     // "table", "shelf": furniture, which statements may ignore
  kFiller,    // words without a meaning here
  kUnknown    // words that name what is not known, or mean nothing
};

// A phrase of a prompt.
struct PromptItem {
  PromptItemKind kind = PromptItemKind::kFiller;
  std::string words;  // as written, in lower case
  NameMatch match;    // of kName
  int number = 0;     // of kNumber, kOrdinal, kVague (of a name)
  int total = 0;      // of kVague, for "objects"
  Relation relation = Relation::kOn;
  bool reversed = false;    // of kRelation: "containing", whose subject is the relation's object
  bool has_object = false;  // of kRelation: "to its left", whose object is a pronoun
  ShelfTier tier = ShelfTier::kTop;
};

// Splits words into phrases, the longest first, from left to right. Throws core::Error for a number
// that is negative, not whole, or above kMostPromptObjects.
std::vector<PromptItem> FindPromptItems(const std::vector<PromptWord>& words,
                                        const NameLookup& lookup);

}  // namespace simwright::scene
