#pragma once

#include "cli/command.h"

namespace simwright::cli {

// Add `simwright scene export` and `scene view`.
void AddSceneExport(CLI::App* scene, CommonOptions* common, Run* run);
void AddSceneView(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
