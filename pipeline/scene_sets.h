#pragma once

#include <filesystem>
#include <vector>

#include "core/finding.h"
#include "core/progress.h"
#include "pipeline/scene_evaluation.h"
#include "scene/dataset/vocabulary.h"
#include "scene/palette.h"

namespace simwright::pipeline {

using SceneSet = std::vector<std::vector<scene::DrawnObject>>;

// The scene sets that an evaluation compares.
struct SceneSets {
  scene::Vocabulary vocabulary;
  scene::Palette palette;
  SceneSet samples;
  SceneSet training;  // all training scenes
  SceneSet held_out;  // at most `count`
};

// Finds, generates and samples the requested sets; keeps new ones in `folder`. Throws as
// EvaluateScenes does.
SceneSets GatherSceneSets(const SceneEvaluationRequest& request,
                          const std::filesystem::path& folder, core::Findings* findings,
                          core::Progress* progress);

}  // namespace simwright::pipeline
