#include "scene/prompt/prompt_reading.h"

#include <algorithm>
#include <cstdint>

#include "core/error.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/name_lookup.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt_items.h"
#include "scene/prompt/prompt_parser.h"
#include "scene/prompt/prompt_words.h"

namespace simwright::scene {
namespace {

constexpr size_t kNearestNames = 3;
constexpr size_t kMostUnknownReported = 5;
constexpr char kExample[] = "\"A scene with two ";

[[noreturn]] void RejectContradiction(const std::string& one, const std::string& other) {
  throw core::Error("\"" + one + "\" contradicts \"" + other + "\"", "prompt", "leave one of them");
}

std::string JoinTexts(const std::vector<std::string>& texts) {
  std::string joined;
  for (const std::string& text : texts) joined += (joined.empty() ? "" : ", ") + text;
  return joined;
}

[[noreturn]] void RejectUnknownPrompt(const ParsedPrompt& parsed, const NameLookup& lookup) {
  const std::vector<std::string>& names = lookup.names();
  std::string remedy = "the known objects are: " + JoinTexts(names);
  if (!names.empty()) {
    remedy += "; for example " + std::string(kExample) + PluralOf(names.front()) + ".\"";
  }
  std::string what = "nothing in the prompt is understood; write English";
  const std::vector<std::string>& words = parsed.unknown.empty() ? parsed.ignored : parsed.unknown;
  if (!words.empty()) {
    what += "; nearest to \"" + words.front() +
            "\": " + JoinTexts(lookup.Nearest(words.front(), kNearestNames));
  }
  throw core::Error(what, "prompt", remedy);
}

void AddUnknownFindings(const ParsedPrompt& parsed, const NameLookup& lookup,
                        core::Findings* findings) {
  std::vector<std::string> unknown;
  for (const std::string& words : parsed.unknown) {
    if (std::find(unknown.begin(), unknown.end(), words) == unknown.end()) unknown.push_back(words);
  }
  for (size_t i = 0; i < std::min(unknown.size(), kMostUnknownReported); ++i) {
    findings->push_back({"prompt-unknown-object", core::Severity::kWarning, "prompt",
                         "\"" + unknown[i] +
                             "\" is not known and ignored; the nearest known objects are " +
                             JoinTexts(lookup.Nearest(unknown[i], kNearestNames))});
  }
  if (unknown.size() > kMostUnknownReported) {
    findings->push_back({"prompt-unknown-object", core::Severity::kWarning, "prompt",
                         std::to_string(unknown.size() - kMostUnknownReported) +
                             " more phrases name objects that are not known"});
  }
  std::vector<std::string> ignored = parsed.ignored;
  if (ignored.empty()) return;
  if (ignored.size() > kMostUnknownReported) ignored.resize(kMostUnknownReported);
  findings->push_back({"prompt-word-ignored", core::Severity::kInfo, "prompt",
                       "these words are not understood and ignored: " + JoinTexts(ignored)});
}

// Returns the names with their counts. Throws core::Error for a name that is asked for and
// excluded.
std::vector<NamedCount> CountsOf(const ParsedPrompt& parsed, const NameLookup& lookup) {
  std::vector<NamedCount> counts;
  for (const MentionedName& one : parsed.names) {
    const int count = one.asked > 0 ? one.asked : one.implied;
    const std::string& words = one.asked > 0 ? one.asked_words : one.implied_words;
    if (one.none && count > 0) RejectContradiction(one.none_words, words);
    if (one.asked > 0 && one.implied > one.asked) {
      RejectContradiction(one.asked_words, one.implied_words);
    }
    counts.push_back({lookup.names()[static_cast<size_t>(one.name)], count});
  }
  return counts;
}

// Sets the total and whether other objects are allowed. Throws core::Error if the total and the
// names contradict each other.
void SetTotal(const ParsedPrompt& parsed, Prompt* prompt) {
  std::int64_t sum = 0;
  std::string words;
  bool any_asked = false;
  for (size_t i = 0; i < parsed.names.size(); ++i) {
    sum += prompt->names[i].count;
    any_asked = any_asked || parsed.names[i].asked > 0;
    const MentionedName& one = parsed.names[i];
    const std::string& part = one.asked > 0 ? one.asked_words : one.implied_words;
    if (prompt->names[i].count > 0) words += (words.empty() ? "" : "\" and \"") + part;
  }
  prompt->and_others = parsed.others || (!any_asked && !parsed.no_others && !prompt->names.empty());
  std::optional<std::int64_t> total;
  if (parsed.total) total = *parsed.total;
  if (parsed.other_count > 0) {
    if (total && *total != sum + parsed.other_count) {
      RejectContradiction(parsed.total_words,
                          std::to_string(parsed.other_count) + " other objects");
    }
    total = sum + parsed.other_count;
  }
  if (!total && sum == 0 && !prompt->and_others) total = 0;  // "no cups and nothing else"
  if (!total) return;
  if (sum > *total) RejectContradiction(parsed.total_words, words);
  if (parsed.total && *total == 0 && !parsed.unknown_asked.empty()) {
    RejectContradiction(parsed.total_words, parsed.unknown_asked);
  }
  if (*total > kMostPromptObjects) throw core::Error("too many objects are asked for", "prompt");
  if (parsed.no_others && sum < *total && sum > 0) {
    RejectContradiction(parsed.total_words, "nothing but " + words);
  }
  prompt->count = static_cast<int>(*total);
  prompt->and_others = sum < *total && !prompt->names.empty();
}

ObjectReference ReferenceOf(const MentionedObject& object, const ParsedPrompt& parsed,
                            const Prompt& prompt) {
  for (size_t i = 0; i < parsed.names.size(); ++i) {
    if (parsed.names[i].name != object.name) continue;
    const NamedCount& named = prompt.names[i];
    return {named.name, named.count == 1 ? 0 : object.number};
  }
  return {};
}

// Returns a number for each relation of which a pair can be in only one; relations of one pair with
// different numbers exclude each other. `mirrored`: for the reversed pair. 0 excludes nothing.
int ExclusiveClass(Relation relation, bool mirrored) {
  switch (relation) {
    case Relation::kOn:
    case Relation::kInside:
      return mirrored ? 2 : 1;
    case Relation::kAbove:
    case Relation::kBelow:
      return (relation == Relation::kAbove) != mirrored ? 3 : 4;
    case Relation::kLeftOf:
    case Relation::kRightOf:
      return (relation == Relation::kLeftOf) != mirrored ? 5 : 6;
    case Relation::kInFrontOf:
    case Relation::kBehind:
      return (relation == Relation::kInFrontOf) != mirrored ? 7 : 8;
    default:
      return 0;
  }
}

void RejectContradictoryStatements(const Prompt& prompt) {
  const auto is_one = [&](const ObjectReference& reference) {
    return reference.ordinal > 0 || prompt.CountOf(reference.name) == 1;
  };
  for (size_t i = 0; i < prompt.relations.size(); ++i) {
    const RelationStatement& a = prompt.relations[i];
    for (size_t j = i + 1; j < prompt.relations.size(); ++j) {
      const RelationStatement& b = prompt.relations[j];
      const bool same = a.subject == b.subject && a.object == b.object;
      const bool reversed = a.subject == b.object && a.object == b.subject;
      if ((!same && !reversed) || !is_one(a.subject) || !is_one(a.object)) continue;
      const int first = ExclusiveClass(a.relation, false);
      const int second = ExclusiveClass(b.relation, reversed);
      if (first == 0 || second == 0 || first == second) continue;
      RejectContradiction(StatementText(a, prompt), StatementText(b, prompt));
    }
  }
  for (size_t i = 0; i < prompt.tiers.size(); ++i) {
    for (size_t j = i + 1; j < prompt.tiers.size(); ++j) {
      const TierStatement &a = prompt.tiers[i], &b = prompt.tiers[j];
      if (!(a.subject == b.subject) || !is_one(a.subject) || a.tier == b.tier) continue;
      RejectContradiction(StatementText(a, prompt), StatementText(b, prompt));
    }
  }
}

void SetStatements(const ParsedPrompt& parsed, Prompt* prompt, core::Findings* findings) {
  for (const MentionedRelation& one : parsed.relations) {
    const RelationStatement statement{ReferenceOf(one.subject, parsed, *prompt), one.relation,
                                      ReferenceOf(one.object, parsed, *prompt)};
    if (statement.subject == statement.object && statement.subject.ordinal > 0) continue;
    if (statement.subject == statement.object && prompt->CountOf(statement.subject.name) == 1) {
      continue;
    }
    prompt->relations.push_back(statement);
  }
  for (const MentionedTier& one : parsed.tiers) {
    prompt->tiers.push_back({ReferenceOf(one.subject, parsed, *prompt), one.tier});
  }
  const auto numbered = [&](const MentionedObject& object) {
    for (const MentionedName& name : parsed.names) {
      if (name.name == object.name) return name.numbered || object.number == 0 || name.asked < 2;
    }
    return true;
  };
  const bool by_mention = std::any_of(parsed.relations.begin(), parsed.relations.end(),
                                      [&](const auto& one) {
                                        return !numbered(one.subject) || !numbered(one.object);
                                      }) ||
                          std::any_of(parsed.tiers.begin(), parsed.tiers.end(),
                                      [&](const auto& one) { return !numbered(one.subject); });
  if (!by_mention) return;
  findings->push_back({"prompt-ordinals", core::Severity::kInfo, "prompt",
                       "objects of one name are numbered from left to right, in the order in "
                       "which the prompt mentions them"});
}

Prompt PromptOf(const ParsedPrompt& parsed, const NameLookup& lookup, core::Findings* findings) {
  Prompt prompt;
  if (parsed.names.empty() && !parsed.total && parsed.other_count == 0) {
    RejectUnknownPrompt(parsed, lookup);
  }
  prompt.names = CountsOf(parsed, lookup);
  SetTotal(parsed, &prompt);
  SetStatements(parsed, &prompt, findings);
  RejectContradictoryStatements(prompt);
  const bool has_statements = !prompt.relations.empty() || !prompt.tiers.empty();
  prompt.kind = has_statements         ? PromptKind::kRelations
                : prompt.names.empty() ? PromptKind::kCount
                                       : PromptKind::kNames;
  std::string error;
  if (!prompt.IsValid(&error)) throw core::Error(error, "prompt");
  return prompt;
}

}  // namespace

PromptReading ReadPrompt(std::string_view text, const std::vector<std::string>& known_names,
                         const physics_params::WordNet* wordnet) {
  const std::vector<PromptWord> words = SplitPrompt(text);
  PromptReading reading;
  if (words.empty()) return reading;
  const NameLookup lookup(known_names, wordnet);
  const ParsedPrompt parsed = ParsePrompt(FindPromptItems(words, lookup), lookup);
  reading.findings = parsed.findings;
  reading.prompt = PromptOf(parsed, lookup, &reading.findings);
  for (const MentionedName& one : parsed.names) {
    if (one.asked > 0 || one.implied == 0) continue;
    reading.referred.push_back(lookup.names()[static_cast<size_t>(one.name)]);
  }
  AddUnknownFindings(parsed, lookup, &reading.findings);
  reading.text = reading.prompt.Text();
  return reading;
}

PromptReading ReadPrompt(std::string_view text, const Vocabulary& vocabulary,
                         const physics_params::WordNet* wordnet) {
  PromptReading reading = ReadPrompt(text, NamesOfVocabulary(vocabulary), wordnet);
  std::int64_t sum = reading.prompt.count.value_or(0);
  if (!reading.prompt.count) {
    for (const NamedCount& one : reading.prompt.names) sum += one.count;
  }
  if (sum > vocabulary.entries) {
    reading.findings.push_back({"prompt-too-many", core::Severity::kWarning, "prompt",
                                std::to_string(sum) +
                                    " objects are asked for, but scenes have at "
                                    "most " +
                                    std::to_string(vocabulary.entries),
                                static_cast<double>(sum)});
  }
  return reading;
}

}  // namespace simwright::scene
