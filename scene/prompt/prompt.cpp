#include "scene/prompt/prompt.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "scene/prompt/object_names.h"

namespace simwright::scene {
namespace {

std::string ReferenceText(const ObjectReference& reference, const Prompt& prompt) {
  if (reference.ordinal > 0) {
    return "the " + OrdinalWord(reference.ordinal) + " " + reference.name;
  }
  if (prompt.CountOf(reference.name) > 1) return "one of the " + PluralOf(reference.name);
  return "the " + reference.name;
}

void AppendSentence(std::string sentence, std::string* text) {
  sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  *text += " " + sentence + ".";
}

// Returns "a bowl", "a bowl and two cups", "a bowl, two cups, and a fork".
std::string ListText(const std::vector<std::string>& parts) {
  std::string text;
  for (size_t i = 0; i < parts.size(); ++i) {
    const bool last = i + 1 == parts.size();
    if (i > 0) text += parts.size() > 2 ? ", " : " ";
    if (i > 0 && last) text += "and ";
    text += parts[i];
  }
  return text;
}

std::string CountText(int count) {
  return std::to_string(count) + (count == 1 ? " object" : " objects");
}

std::string FaultOfReference(const ObjectReference& reference, const Prompt& prompt) {
  const int count = prompt.CountOf(reference.name);
  if (count == 0) return "a statement is about an object that is not named: " + reference.name;
  if (reference.ordinal < 0 || reference.ordinal > count) {
    return "there is no " + reference.name + " number " + std::to_string(reference.ordinal);
  }
  return "";
}

std::string FaultOfStatements(const Prompt& prompt) {
  for (const RelationStatement& statement : prompt.relations) {
    for (const ObjectReference* reference : {&statement.subject, &statement.object}) {
      const std::string fault = FaultOfReference(*reference, prompt);
      if (!fault.empty()) return fault;
    }
    const bool may_be_one = prompt.CountOf(statement.subject.name) == 1 ||
                            statement.subject.ordinal == statement.object.ordinal;
    if (statement.subject.name == statement.object.name && may_be_one &&
        (statement.subject.ordinal > 0 || prompt.CountOf(statement.subject.name) == 1)) {
      return "an object has a relation to itself: " + statement.subject.name;
    }
  }
  for (const TierStatement& statement : prompt.tiers) {
    const std::string fault = FaultOfReference(statement.subject, prompt);
    if (!fault.empty()) return fault;
  }
  return "";
}

std::string FaultOfNames(const Prompt& prompt) {
  std::set<std::string> names;
  std::int64_t sum = 0;
  for (const NamedCount& one : prompt.names) {
    if (one.name.empty()) return "an object has no name";
    if (one.count < 0 || one.count > kMostPromptObjects) {
      return "the count of " + one.name + " must be 0 to " + std::to_string(kMostPromptObjects);
    }
    if (!names.insert(one.name).second) return "an object is named twice: " + one.name;
    sum += one.count;
  }
  if (!prompt.count) return "";
  if (sum > *prompt.count) {
    return std::to_string(sum) + " objects are named, but only " + CountText(*prompt.count) +
           " asked for";
  }
  if (!prompt.names.empty() && sum < *prompt.count && !prompt.and_others) {
    return "fewer objects are named than asked for, without others";
  }
  return "";
}

std::string FaultOfPrompt(const Prompt& prompt) {
  const bool has_statements = !prompt.relations.empty() || !prompt.tiers.empty();
  const auto kind = has_statements          ? PromptKind::kRelations
                    : !prompt.names.empty() ? PromptKind::kNames
                    : prompt.count          ? PromptKind::kCount
                                            : PromptKind::kEmpty;
  if (kind != prompt.kind) return "the kind of the prompt does not match its contents";
  if (prompt.and_others && prompt.names.empty()) return "other objects are asked for without names";
  if (prompt.count && (*prompt.count < 0 || *prompt.count > kMostPromptObjects)) {
    return "the number of objects must be 0 to " + std::to_string(kMostPromptObjects);
  }
  const std::string fault = FaultOfNames(prompt);
  return fault.empty() ? FaultOfStatements(prompt) : fault;
}

}  // namespace

bool Prompt::IsValid(std::string* error) const {
  *error = FaultOfPrompt(*this);
  return error->empty();
}

int Prompt::CountOf(const std::string& name) const {
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](const NamedCount& one) { return one.name == name; });
  return found == names.end() ? 0 : found->count;
}

std::string Prompt::Text() const {
  if (kind == PromptKind::kEmpty) return "";
  std::string text = "A scene with ";
  if (count) text += CountText(*count);
  if (count && !names.empty()) text += ": ";
  std::vector<std::string> parts;
  for (const NamedCount& one : names) parts.push_back(CountedName(one.count, one.name));
  if (and_others) parts.push_back("some other objects");
  text += ListText(parts) + ".";
  for (const RelationStatement& one : relations) AppendSentence(StatementText(one, *this), &text);
  for (const TierStatement& one : tiers) AppendSentence(StatementText(one, *this), &text);
  return text;
}

std::string StatementText(const RelationStatement& statement, const Prompt& prompt) {
  return ReferenceText(statement.subject, prompt) + " is " + RelationText(statement.relation) +
         " " + ReferenceText(statement.object, prompt);
}

std::string StatementText(const TierStatement& statement, const Prompt& prompt) {
  return ReferenceText(statement.subject, prompt) + " is " + ShelfTierText(statement.tier);
}

}  // namespace simwright::scene
