#pragma once

#include "cli/command.h"

namespace simwright::cli {

// Adds `simwright scene posttrain`.
void AddScenePosttrain(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
