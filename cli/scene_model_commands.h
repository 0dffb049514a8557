#pragma once

#include "cli/command.h"

namespace simwright::cli {

// Add `simwright scene train`, `scene sample`, `scene evaluate` and `scene features`.
void AddSceneTrain(CLI::App* scene, CommonOptions* common, Run* run);
void AddSceneSample(CLI::App* scene, CommonOptions* common, Run* run);
void AddSceneEvaluate(CLI::App* scene, CommonOptions* common, Run* run);
void AddSceneFeatures(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
