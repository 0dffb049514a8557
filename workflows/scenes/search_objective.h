#pragma once

#include <memory>
#include <string>

#include "core/finding.h"
#include "scene/asset_set/asset_set.h"
#include "scene/dataset/vocabulary.h"
#include "steering/rewards/scene_reward.h"
#include "steering/search/mask_generator.h"
#include "steering/search/scene_search.h"

namespace simwright::workflows {

// The objective of a search, as a command names it.
struct SearchObjective {
  // "feasible", "objects" or an expression of counts (steering::RewardNamed); "solvable" or
  // "hard-but-solvable", for `task` (SolvableReward).
  std::string objective = "feasible";
  std::string task;    // a robot's, as ReadCertifyTask takes it
  std::string prompt;  // free text, instead of `objective`; empty: none
  std::string mask = "empty,penetrating,unstable";
};

// The objects that a search needs for its objective.
struct SearchGoal {
  std::unique_ptr<steering::SceneReward> reward;
  std::unique_ptr<steering::MaskGenerator> mask;
  std::string prompt;         // in the wording that models read; empty: none
  std::vector<char> allowed;  // SearchOptions::allowed
  int most_objects = 0;       // SearchOptions::most_objects
};

// Makes the reward and the mask. With a prompt, objects that it does not ask for are masked, too,
// and new objects have its names. Adds the findings of its words. `asset_set` must outlive the
// goal. Throws core::Error for an unknown objective or mask, a prompt or task that cannot be read,
// and a task without an objective that needs one, or the reverse.
SearchGoal MakeSearchGoal(const SearchObjective& objective, const scene::Vocabulary& vocabulary,
                          const scene::AssetSet& asset_set, core::Findings* findings);

}  // namespace simwright::workflows
