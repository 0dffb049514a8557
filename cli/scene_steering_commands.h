#pragma once

#include "cli/command.h"

namespace simwright::cli {

// Add `simwright scene complete` and `scene rearrange`.
void AddSceneComplete(CLI::App* scene, CommonOptions* common, Run* run);
void AddSceneRearrange(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
