#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/finding.h"
#include "core/json.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/category_size.h"
#include "scene/grammar/scene_sample.h"
#include "scene/prompt/prompt.h"

namespace simwright::workflows {

struct RequestedPrompts {
  std::vector<scene::Prompt> prompts;
  std::vector<std::string> types;  // the scene type that each names; empty: none
  std::vector<std::vector<std::string>> referred = {};  // PromptReading::referred of each
};

// Reads prompts in free text, and the scene types of `types` that they name: "a pantry shelf with
// two apples". A prompt of a type alone is empty. Otherwise as ReadPrompts.
RequestedPrompts ReadPromptsAndTypes(const std::vector<std::string>& texts,
                                     const std::filesystem::path& file,
                                     const scene::Vocabulary& vocabulary,
                                     const std::vector<std::string>& types,
                                     core::Findings* findings);

// Reads prompts in free text: `texts`, then the lines of `file` (empty: none) that are not blank.
// Adds the findings of their words to `findings`. Throws core::Error for a missing file and as
// scene::ReadPrompt does, naming the prompt.
std::vector<scene::Prompt> ReadPrompts(const std::vector<std::string>& texts,
                                       const std::filesystem::path& file,
                                       const scene::Vocabulary& vocabulary,
                                       core::Findings* findings);

// Returns the line of an error of scene::ReadPrompt without the place "prompt", for an error that
// names the option. A place within the prompt stays.
std::string PromptErrorLine(const core::Error& error);

// Returns the statements of a prompt as sentences, in the order of PromptAgreement::holds.
std::vector<std::string> StatementsOf(const scene::Prompt& prompt);

// Returns the texts that a model reads.
std::vector<std::string> TextsOf(const std::vector<scene::Prompt>& prompts);

// The agreement of scenes with a prompt, means over its scenes.
struct PromptReport {
  std::string text;
  int scenes = 0;
  double apf = 0.0;     // PromptAgreement::apf
  double strict = 0.0;  // share of scenes that agree exactly
  int complete = 0;     // scenes with an object of each name asked for; without names all
  int statements = 0;   // relations and tiers that the prompt asks for
  double held = 0.0;    // share of them that hold
  // The statements that do not hold in every scene, and in how many they do not.
  struct Broken {
    std::string statement;
    int scenes = 0;
  };
  std::vector<Broken> broken;
};

// Returns one report per prompt; scene i has prompt i % n, and is left out if `counted` is 0 for
// it (empty: all count). Empty if there are no prompts.
std::vector<PromptReport> ReportsOf(const std::vector<scene::Prompt>& prompts,
                                    const std::vector<std::vector<scene::SceneObject>>& scenes,
                                    const scene::CategorySizes& sizes,
                                    const std::vector<char>& counted = {});

// Format the reports as lines for people, the last one about all prompts if there are several, and
// as JSON.
std::string PromptTable(const std::vector<PromptReport>& reports);
core::OrderedJson PromptJson(const std::vector<PromptReport>& reports);

}  // namespace simwright::workflows
