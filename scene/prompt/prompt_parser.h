#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/finding.h"
#include "scene/prompt/prompt_items.h"

namespace simwright::scene {

// An object that a prompt mentions: `number` counts the objects of its name in the order of their
// mention, from 1; 0 is any of them.
struct MentionedObject {
  int name = -1;  // index into the known names
  int number = 0;

  bool operator==(const MentionedObject&) const = default;
};
using Mention = std::vector<MentionedObject>;

// The objects of one name that a prompt asks for.
struct MentionedName {
  int name = -1;
  int asked = 0;          // by counts and articles
  int implied = 0;        // by references: "the second apple"
  bool none = false;      // "no apples"
  bool numbered = false;  // a reference with an ordinal was used
  std::string asked_words, implied_words, none_words;
};

struct MentionedRelation {
  MentionedObject subject;
  Relation relation;
  MentionedObject object;

  bool operator==(const MentionedRelation&) const = default;
};

struct MentionedTier {
  MentionedObject subject;
  ShelfTier tier;

  bool operator==(const MentionedTier&) const = default;
};

// The contents of a text, before contradictions are looked for.
struct ParsedPrompt {
  std::vector<MentionedName> names;  // in the order of their first mention
  std::optional<int> total;          // objects
  std::string total_words;
  bool others = false, no_others = false;
  int other_count = 0;  // of "5 other objects"; 0: not stated
  std::vector<MentionedRelation> relations;
  std::vector<MentionedTier> tiers;
  std::vector<std::string> unknown;  // phrases that name an object that is not known
  std::string unknown_asked;         // the first of them that is asked for, with its quantity
  std::vector<std::string> ignored;  // words without a meaning here
  core::Findings findings;
};

// Interprets the phrases of a prompt from left to right. Throws core::Error for two different
// totals and for more than kMostPromptObjects objects.
ParsedPrompt ParsePrompt(const std::vector<PromptItem>& items, const NameLookup& lookup);

}  // namespace simwright::scene
