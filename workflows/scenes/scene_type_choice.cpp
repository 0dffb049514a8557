#include "workflows/scenes/scene_type_choice.h"

#include <algorithm>

#include "core/error.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/scene_type_words.h"
#include "scene/scene_types/scene_types.h"

namespace simwright::workflows {
namespace {

// Returns the number of names in the prompts that objects of a scene type may have.
int KnownNames(const scene::SceneModelType& type, const std::vector<scene::Prompt>& prompts) {
  int known = 0;
  for (const scene::Prompt& prompt : prompts) {
    for (const scene::NamedCount& one : prompt.names) {
      known += std::any_of(
          type.categories.begin(), type.categories.end(),
          [&](const std::string& category) { return scene::NameOfCategory(category) == one.name; });
    }
  }
  return known;
}

}  // namespace

std::vector<std::string> TypesToRead(const scene::SceneModelMetadata& metadata) {
  std::vector<std::string> types = metadata.TypeNames();
  for (const scene::SceneType& one : scene::SceneTypes()) {
    if (std::find(types.begin(), types.end(), one.name) == types.end()) types.push_back(one.name);
  }
  return types;
}

std::string ChooseSceneType(const scene::SceneModelMetadata& metadata, const std::string& asked,
                            const RequestedPrompts& prompts, core::Findings* findings) {
  const std::vector<std::string> known = metadata.TypeNames();
  for (const std::string& one : prompts.types) {
    const bool of_model = std::find(known.begin(), known.end(), one) != known.end();
    const bool sampled = asked.empty() ? of_model : one == asked;
    if (one.empty() || sampled) continue;
    findings->push_back({"scene-type-ignored", core::Severity::kWarning, "prompt",
                         "the prompt names another scene type, " + one +
                             (asked.empty() ? ", which the model does not have" : "") +
                             "; only its objects count"});
    break;
  }
  if (!asked.empty()) return metadata.OfType(asked).vocabulary.type;
  if (metadata.types.empty()) return metadata.vocabulary.type;
  std::string named;
  for (const std::string& one : prompts.types) {
    if (std::find(known.begin(), known.end(), one) == known.end()) continue;
    if (!named.empty() && !one.empty() && one != named) {
      throw core::Error("the prompts name different scene types", named + ", " + one,
                        "sample them one after the other");
    }
    if (!one.empty()) named = one;
  }
  if (!named.empty()) return named;
  int most = 0;
  for (const scene::SceneModelType& type : metadata.types) {
    const int known = KnownNames(type, prompts.prompts);
    if (known <= most) continue;
    most = known;
    named = type.name;
  }
  if (most == 0) {
    std::string list;
    for (const std::string& name : metadata.TypeNames()) list += (list.empty() ? "" : ", ") + name;
    throw core::Error("the model has several scene types", list,
                      "choose one: --type, or \"a " +
                          scene::WordsOfSceneType(metadata.types.front().name) +
                          " with ...\" in the prompt");
  }
  findings->push_back({"scene-type-guessed", core::Severity::kInfo, "prompt",
                       "the scene type is chosen by the named objects: " + named +
                           " (--type chooses another one)"});
  return named;
}

void CheckSceneType(const scene::SceneModelMetadata& metadata, const std::string& asked,
                    const std::filesystem::path& weights) {
  if (asked.empty() || !metadata.types.empty() || asked == metadata.vocabulary.type) return;
  throw core::Error(
      "the model has scenes of the type " + metadata.vocabulary.type + " only, not " + asked,
      weights.string(), "leave --type out, or leave the model out for the shipped weights");
}

}  // namespace simwright::workflows
