#pragma once

#include "cli/command.h"

namespace simwright::cli {

// `simwright scene train` and `scene sample`.
void AddSceneTrain(CLI::App* scene, CommonOptions* common, Run* run);
void AddSceneSample(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
