#include "scene/prompt/mention_resolution.h"

#include <algorithm>

#include "core/error.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt.h"

namespace simwright::scene {
namespace {

constexpr int kBarePlural = 3;         // objects of "apples"
constexpr size_t kMostMentioned = 20;  // objects of one mention that statements are made about
constexpr size_t kMostNotes = 50;

Mention FirstObjectsOf(int name, int count) {
  Mention mention;
  for (int i = 1; i <= count && mention.size() < kMostMentioned; ++i) mention.push_back({name, i});
  return mention;
}

}  // namespace

MentionedName& MentionedNameOf(int name, ParsedPrompt* parsed) {
  for (MentionedName& state : parsed->names) {
    if (state.name == name) return state;
  }
  parsed->names.push_back({});
  parsed->names.back().name = name;
  return parsed->names.back();
}

void AddPromptNote(const char* code, core::Severity severity, const std::string& sentence,
                   core::Findings* findings) {
  const auto same = [&](const core::Finding& one) { return one.sentence == sentence; };
  const bool known = std::any_of(findings->begin(), findings->end(), same);
  if (known || findings->size() >= kMostNotes) return;
  findings->push_back({code, severity, "prompt", sentence});
}

// Adds objects to those asked for and returns them.
Mention MentionResolver::Add(MentionedName* state, int count, const std::string& words) {
  const std::string& name = lookup_.names()[static_cast<size_t>(state->name)];
  if (state->asked > kMostPromptObjects - count) {
    throw core::Error(
        "more than " + std::to_string(kMostPromptObjects) + " " + PluralOf(name) + " are asked for",
        "prompt", "ask for fewer");
  }
  if (state->asked > 0) {
    Note("prompt-repeated-name",
         PluralOf(name) + " are asked for more than once; the numbers are added");
    state->asked_words += "\" and \"" + words;
  } else {
    state->asked_words = words;
  }
  Mention mention;
  for (int i = 1; i <= count && mention.size() < kMostMentioned; ++i) {
    mention.push_back({state->name, state->asked + i});
  }
  state->asked += count;
  return mention;
}

// Returns the objects that a name with its quantity means.
Mention MentionResolver::Resolve(const MentionQuantity& quantity, const PromptItem& item) {
  MentionedName& state = MentionedNameOf(item.match.name, &parsed_);
  const std::string words = (quantity.words.empty() ? "" : quantity.words + " ") + item.words;
  const int known = std::max(state.asked, state.implied);
  const bool plural = item.match.plural;
  const auto imply = [&](int count) {
    if (count > state.implied) state.implied_words = words;
    state.implied = std::max(state.implied, count);
  };
  if (quantity.one_of) {
    imply(2);
    return {{state.name, 0}};
  }
  if (quantity.ordinal > 0 && !quantity.number) {
    if (quantity.ordinal > kMostPromptObjects) throw core::Error("an ordinal is too large", words);
    imply(quantity.ordinal);
    state.numbered = true;
    return {{state.name, quantity.ordinal}};
  }
  if (quantity.number && !(quantity.definite && known >= *quantity.number)) {
    return Add(&state, *quantity.number, words);
  }
  if (quantity.number) return FirstObjectsOf(state.name, *quantity.number);
  const bool before = quantity.definite || (statement_ && known > 0 && !quantity.another);
  if (before && !quantity.vague) {
    imply(plural ? std::max(2, known) : 1);
    const int count = std::max(state.asked, state.implied);
    if (plural) return FirstObjectsOf(state.name, count);
    return {{state.name, count == 1 ? 1 : 0}};
  }
  int count = 1;
  if (plural) count = quantity.vague ? quantity.vague->number : kBarePlural;
  if (count > 1) {
    Note("prompt-number-chosen",
         "\"" + words + "\" is read as " +
             CountedName(count, lookup_.names()[static_cast<size_t>(state.name)]));
  }
  return Add(&state, count, words);
}

}  // namespace simwright::scene
