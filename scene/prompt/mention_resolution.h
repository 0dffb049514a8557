#pragma once

#include <optional>
#include <string>

#include "core/finding.h"
#include "scene/prompt/name_lookup.h"
#include "scene/prompt/prompt_items.h"
#include "scene/prompt/prompt_parser.h"

namespace simwright::scene {

// The words before a name: how many, and whether it is an object that was mentioned before.
struct MentionQuantity {
  std::optional<int> number;
  std::optional<PromptItem> vague;
  int ordinal = 0;
  bool article = false, another = false, definite = false, one_of = false;
  std::string words;

  bool Any() const { return number || vague || ordinal > 0 || article || definite || one_of; }
};

// Returns the state of a name in `parsed`, which is added where it is new.
MentionedName& MentionedNameOf(int name, ParsedPrompt* parsed);

// Adds a note on a prompt unless there is one with this sentence, or there are 50 notes.
void AddPromptNote(const char* code, core::Severity severity, const std::string& sentence,
                   core::Findings* findings);

// Decides which objects a name with the words before it means: new ones, which are added to those
// asked for, or ones that were mentioned before.
class MentionResolver {
 public:
  // `statement`: the sentence says where objects are, so that a name repeats an earlier one.
  MentionResolver(const NameLookup& lookup, bool statement, ParsedPrompt* parsed)
      : lookup_(lookup), statement_(statement), parsed_(*parsed) {}

  // Returns the objects. Throws core::Error for more than kMostPromptObjects objects or an ordinal
  // beyond it.
  Mention Resolve(const MentionQuantity& quantity, const PromptItem& item);

 private:
  Mention Add(MentionedName* state, int count, const std::string& words);
  void Note(const char* code, const std::string& sentence) {
    AddPromptNote(code, core::Severity::kInfo, sentence, &parsed_.findings);
  }

  const NameLookup& lookup_;
  bool statement_;
  ParsedPrompt& parsed_;
};

}  // namespace simwright::scene
