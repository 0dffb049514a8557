#include "workflows/scenes/steering_goal.h"

#include <algorithm>

#include "core/error.h"
#include "workflows/scenes/scene_prompts.h"

namespace simwright::workflows {

void SetGoalFromPrompt(const std::string& text, const scene::Vocabulary& vocabulary,
                       SteeringGoal* goal, core::Findings* findings) {
  const RequestedPrompts read = ReadPromptsAndTypes({text}, {}, vocabulary, {}, findings);
  const scene::Prompt& prompt = read.prompts.front();
  const std::vector<std::string>& referred = read.referred.front();
  goal->names.clear();
  goal->referred.clear();
  goal->prompt = prompt;
  goal->count = 0;
  for (const scene::NamedCount& one : prompt.names) {
    if (one.count == 0) continue;
    if (std::find(referred.begin(), referred.end(), one.name) != referred.end()) {
      goal->referred.push_back(one);
      continue;
    }
    goal->names.push_back(one);
    goal->count += one.count;
  }
  const bool names_any = !goal->names.empty() || !goal->referred.empty();
  if (!names_any) goal->count = prompt.count.value_or(0);
  if (goal->count == 0 && !names_any) {
    throw core::Error("the prompt asks for no objects", "--prompt",
                      "name what to add, as in \"two apples and a can\"");
  }
  const auto warn = [&](const char* rule, const std::string& sentence) {
    findings->push_back({rule, core::Severity::kWarning, "--prompt", sentence, 0.0});
  };
  const bool others = (prompt.and_others && !goal->names.empty()) ||
                      (!goal->names.empty() && prompt.count && *prompt.count > goal->count);
  if (others) warn("others-not-added", "only the named objects are added");
}

}  // namespace simwright::workflows
