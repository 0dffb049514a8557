#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/prompt/relation.h"

namespace simwright::scene {

// The three published kinds of prompts (Pfaff et al., Steerable Scene Generation, appendix), and
// the empty prompt of an unconditional sample.
enum class PromptKind { kEmpty, kCount, kNames, kRelations };

struct NamedCount {
  std::string name;  // of NameOfCategory
  int count = 1;     // 0: none of them

  bool operator==(const NamedCount&) const = default;
};

// An object of a scene by its name, and by its ordinal among the objects of that name
// (OrdinalOrder), from 1. Ordinal 0 is any of them: the only one, if there is one.
struct ObjectReference {
  std::string name;
  int ordinal = 0;

  bool operator==(const ObjectReference&) const = default;
};

struct RelationStatement {
  ObjectReference subject;
  Relation relation = Relation::kOn;
  ObjectReference object;

  bool operator==(const RelationStatement&) const = default;
};

struct TierStatement {
  ObjectReference subject;
  ShelfTier tier = ShelfTier::kTop;

  bool operator==(const TierStatement&) const = default;
};

// A request for a scene. Furniture is never counted or named.
struct Prompt {
  PromptKind kind = PromptKind::kEmpty;
  // The number of objects in the scene. kCount needs it; with names it is optional.
  std::optional<int> count;
  std::vector<NamedCount> names;  // each name once; required by kNames and kRelations
  bool and_others = false;        // false: no objects of other names
  std::vector<RelationStatement> relations;
  std::vector<TierStatement> tiers;

  // Checks the kind, the counts (0 to kMostPromptObjects), and the statements, whose objects must
  // be among `names` with an ordinal of at most their count and differ from their subject.
  bool IsValid(std::string* error) const;

  // Returns the prompt in the fixed wording that models read: "A scene with 12 objects.", "A scene
  // with two apples, a bowl, and some other objects.", with relations in further sentences: "The
  // first apple is to the left of the bowl.". Empty for kEmpty. Requires a valid prompt.
  std::string Text() const;

  // Returns the count of the name in `names`; 0 if it is missing.
  int CountOf(const std::string& name) const;

  bool operator==(const Prompt&) const = default;
};

inline constexpr int kMostPromptObjects = 10000;

// Returns a statement as a sentence without its full stop: "the first apple is on the bowl". A
// reference without ordinal to a name of which `prompt` has several is "one of the apples".
std::string StatementText(const RelationStatement& statement, const Prompt& prompt);
std::string StatementText(const TierStatement& statement, const Prompt& prompt);

}  // namespace simwright::scene
