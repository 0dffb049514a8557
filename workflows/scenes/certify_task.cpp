#include "workflows/scenes/certify_task.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "core/error.h"
#include "physics_params/wordnet.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt_reading.h"
#include "workflows/scenes/scene_prompts.h"

namespace simwright::workflows {
namespace {

using Words = std::vector<std::string>;

constexpr int kMostOrdinal = 50;
constexpr size_t kMostTaskWords = 60;

const Words kBringVerbs = {"bring", "move",  "take", "get",  "fetch",
                           "put",   "carry", "pull", "place"};
const Words kLiftVerbs = {"lift", "raise", "grasp", "grab", "pick"};
const Words kFrontWords = {"front", "forward", "forwards", "out", "me"};
const Words kFillers = {"up", "the", "a", "an", "over"};
const Words kOrdinalEndings = {"st", "nd", "rd", "th"};
// Words between the object and its destination.
const Words kTowards = {"to", "into", "in", "at", "next", "beside", "near", "by"};

bool IsOneOf(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

Words WordsOf(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    plain += std::isalnum(byte) || byte >= 0x80 || c == '_' || c == '-'
                 ? static_cast<char>(std::tolower(byte))
                 : ' ';
  }
  std::istringstream stream(plain);
  Words words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

[[noreturn]] void FailForm(const std::string& text) {
  throw core::Error("the task \"" + text + "\" is not understood", "--task",
                    "write \"bring the apple to the front\", \"bring the apple to the bowl\" or "
                    "\"lift the apple\"");
}

// Reads the phrase as a prompt, whose errors name the option.
scene::PromptReading ReadPhrase(const std::string& phrase, const std::vector<std::string>& names) {
  try {
    return scene::ReadPrompt(phrase, names, physics_params::WordNet::Installed());
  } catch (const core::Error& error) {
    throw core::Error(PromptErrorLine(error), "--task");
  }
}

// Reads an object: an ordinal and a name.
scene::ObjectReference ReadReference(Words words, const std::vector<std::string>& known_names,
                                     core::Findings* findings) {
  scene::ObjectReference reference;
  for (size_t i = 0; i < words.size(); ++i) {
    for (int ordinal = 1; ordinal <= kMostOrdinal; ++ordinal) {
      const std::string digits = std::to_string(ordinal);
      const bool numbered = words[i].size() == digits.size() + 2 &&
                            words[i].compare(0, digits.size(), digits) == 0 &&
                            IsOneOf(kOrdinalEndings, words[i].substr(digits.size()));
      if (!numbered && words[i] != scene::OrdinalWord(ordinal)) continue;
      reference.ordinal = ordinal;
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    if (reference.ordinal > 0) break;
  }
  std::string phrase;
  for (const std::string& word : words) phrase += (phrase.empty() ? "" : " ") + word;
  const scene::PromptReading reading = ReadPhrase(phrase, known_names);
  for (const core::Finding& finding : reading.findings) {
    findings->push_back(finding);
    findings->back().place = "--task";
  }
  if (reading.prompt.names.size() != 1) {
    throw core::Error("\"" + phrase + "\" is not one object", "--task",
                      "name one object, such as \"the second apple\"");
  }
  reference.name = reading.prompt.names.front().name;
  return reference;
}

std::string ReferenceText(const scene::ObjectReference& reference) {
  const std::string ordinal =
      reference.ordinal > 0 ? scene::OrdinalWord(reference.ordinal) + " " : "";
  return "the " + ordinal + reference.name;
}

}  // namespace

std::string CertifyTask::Text() const {
  switch (kind) {
    case CertifyKind::kFront:
      return "bring " + ReferenceText(object) + " to the front";
    case CertifyKind::kBeside:
      return "bring " + ReferenceText(object) + " next to " + ReferenceText(other);
    case CertifyKind::kLift:
      break;
  }
  return "lift " + ReferenceText(object);
}

CertifyTask ReadCertifyTask(const std::string& text, const std::vector<std::string>& known_names,
                            core::Findings* findings) {
  Words words = WordsOf(text);
  if (words.size() > kMostTaskWords) {
    throw core::Error("the task is too long", "--task", "write one short sentence");
  }
  const auto verb = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return IsOneOf(kBringVerbs, word) || IsOneOf(kLiftVerbs, word);
  });
  if (verb == words.end()) FailForm(text);
  const bool lifts = IsOneOf(kLiftVerbs, *verb);
  Words rest(verb + 1, words.end());
  // Splits at the first word of a destination after the object.
  const auto split = std::find_if(rest.begin(), rest.end(), [](const std::string& word) {
    return IsOneOf(kTowards, word) || IsOneOf(kFrontWords, word);
  });
  const auto plain = [](Words::const_iterator from, Words::const_iterator to) {
    Words kept;
    std::copy_if(from, to, std::back_inserter(kept), [](const std::string& word) {
      return !IsOneOf(kFillers, word) && !IsOneOf(kTowards, word);
    });
    return kept;
  };
  const Words object = plain(rest.begin(), split), place = plain(split, rest.end());
  if (object.empty()) FailForm(text);
  CertifyTask task;
  task.object = ReadReference(object, known_names, findings);
  if (place.empty()) {
    if (!lifts) FailForm(text);
    task.kind = CertifyKind::kLift;
    return task;
  }
  if (std::any_of(place.begin(), place.end(),
                  [](const std::string& word) { return IsOneOf(kFrontWords, word); })) {
    return task;
  }
  task.kind = CertifyKind::kBeside;
  task.other = ReadReference(place, known_names, findings);
  return task;
}

}  // namespace simwright::workflows
