#pragma once

#include <filesystem>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "scene/asset_set/asset_set.h"
#include "scene/dataset/vocabulary.h"
#include "scene/prompt/prompt.h"
#include "workflows/scenes/scene_evaluation.h"

namespace simwright::workflows {

using SceneSet = std::vector<std::vector<scene::SceneObject>>;

// The scene sets that an evaluation compares.
struct SceneSets {
  scene::Vocabulary vocabulary;
  scene::AssetSet asset_set;
  SceneSet samples;
  SceneSet training;  // all training scenes
  SceneSet held_out;  // at most `count`
  // The prompts of the samples, sample i with prompt i; empty if they have none.
  std::vector<scene::Prompt> prompts;
  SceneSet prompted_scenes;  // the held-out scenes that the prompts were drawn from, if known
};

// Finds, generates and samples the requested sets; keeps new ones in `folder`. Throws as
// EvaluateScenes does.
SceneSets GatherSceneSets(const SceneEvaluationRequest& request,
                          const std::filesystem::path& folder, core::Findings* findings,
                          core::Progress* progress);

}  // namespace simwright::workflows
