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

// What an evaluation compares.
struct SceneSets {
  scene::Vocabulary vocabulary;
  scene::Palette palette;
  SceneSet samples;
  SceneSet training;  // all of them
  SceneSet held_out;  // `count` at most
};

// Finds, generates and samples what the request asks for; what is made is kept in `folder`. Throws
// as EvaluateScenes.
SceneSets GatherSceneSets(const SceneEvaluationRequest& request,
                          const std::filesystem::path& folder, core::Findings* findings,
                          core::Progress* progress);

}  // namespace simwright::pipeline
