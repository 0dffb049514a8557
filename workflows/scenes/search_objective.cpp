#include "workflows/scenes/search_objective.h"

#include <algorithm>

#include "core/error.h"
#include "scene/prompt/object_names.h"
#include "steering/rewards/scene_rewards.h"
#include "workflows/scenes/certify_task.h"
#include "workflows/scenes/scene_prompts.h"
#include "workflows/scenes/solvable_reward.h"

namespace simwright::workflows {
namespace {

constexpr std::uint64_t kTaskSeed = 1;  // of the plans

// Returns the classes that a prompt names; empty if it allows others or names none.
std::vector<char> NamedClasses(const scene::Prompt& prompt, const scene::Vocabulary& vocabulary) {
  std::vector<char> named;
  if (prompt.names.empty() || prompt.and_others) return named;
  for (const std::string& category : vocabulary.categories) {
    named.push_back(prompt.CountOf(scene::NameOfCategory(category)) > 0);
  }
  return named;
}

// Returns the number of objects that a prompt asks for; 0 if it leaves it open.
int ObjectsAskedFor(const scene::Prompt& prompt) {
  if (prompt.count.has_value()) return *prompt.count;
  if (prompt.and_others) return 0;
  int count = 0;
  for (const scene::NamedCount& one : prompt.names) count += one.count;
  return count;
}

// Returns the reward of an objective without a prompt.
std::unique_ptr<steering::SceneReward> RewardOf(const SearchObjective& objective,
                                                const scene::Vocabulary& vocabulary,
                                                const scene::AssetSet& asset_set,
                                                core::Findings* findings) {
  const bool hard = objective.objective == "hard-but-solvable";
  if (!hard && objective.objective != "solvable") {
    if (!objective.task.empty()) {
      throw core::Error("a task needs the objective solvable or hard-but-solvable", "--task");
    }
    return steering::RewardNamed(objective.objective, vocabulary);
  }
  if (objective.task.empty()) {
    throw core::Error("this objective needs a task", "--objective " + objective.objective,
                      "give --task, as in \"bring the apple to the front\"");
  }
  const CertifyTask task =
      ReadCertifyTask(objective.task, scene::NamesOfVocabulary(vocabulary), findings);
  return SolvableReward(task, hard ? Solvability::kHardButSolvable : Solvability::kSolvable,
                        asset_set, kTaskSeed);
}

}  // namespace

SearchGoal MakeSearchGoal(const SearchObjective& objective, const scene::Vocabulary& vocabulary,
                          const scene::AssetSet& asset_set, core::Findings* findings) {
  SearchGoal goal;
  goal.mask = steering::MaskNamed(objective.mask, vocabulary);
  if (objective.prompt.empty()) {
    goal.reward = RewardOf(objective, vocabulary, asset_set, findings);
    return goal;
  }
  if (objective.objective != "feasible") {
    throw core::Error("give either an objective or a prompt, not both", "--objective, --prompt");
  }
  const scene::Prompt prompt = ReadPrompts({objective.prompt}, {}, vocabulary, findings).front();
  goal.reward = steering::PromptReward(prompt, asset_set.Sizes());
  std::vector<std::unique_ptr<steering::MaskGenerator>> masks;
  masks.push_back(std::move(goal.mask));
  masks.push_back(steering::SurplusMask(vocabulary, prompt));
  goal.mask = steering::UnionMask(std::move(masks));
  goal.prompt = prompt.Text();
  goal.allowed = NamedClasses(prompt, vocabulary);
  if (std::count(goal.allowed.begin(), goal.allowed.end(), 1) == 0) goal.allowed.clear();
  goal.most_objects = ObjectsAskedFor(prompt);
  return goal;
}

}  // namespace simwright::workflows
