#include "workflows/scenes/steering_goal.h"

#include "core/error.h"
#include "workflows/scenes/scene_prompts.h"

namespace simwright::workflows {

void SetGoalFromPrompt(const std::string& text, const scene::Vocabulary& vocabulary,
                       SteeringGoal* goal, core::Findings* findings) {
  const scene::Prompt prompt = ReadPrompts({text}, {}, vocabulary, findings).front();
  goal->names.clear();
  goal->count = 0;
  for (const scene::NamedCount& one : prompt.names) {
    if (one.count == 0) continue;
    goal->names.push_back(one);
    goal->count += one.count;
  }
  if (goal->names.empty()) goal->count = prompt.count.value_or(0);
  if (goal->count == 0) {
    throw core::Error("the prompt asks for no objects", "--prompt",
                      "name what to add, as in \"two apples and a can\"");
  }
  const auto warn = [&](const char* rule, const std::string& sentence) {
    findings->push_back({rule, core::Severity::kWarning, "--prompt", sentence, 0.0});
  };
  if (!prompt.relations.empty() || !prompt.tiers.empty()) {
    warn("relations-not-kept", "the objects are added, but where they stand is the model's choice");
  }
  const bool others =
      prompt.and_others || (!goal->names.empty() && prompt.count && *prompt.count > goal->count);
  if (others) warn("others-not-added", "only the named objects are added");
}

}  // namespace simwright::workflows
