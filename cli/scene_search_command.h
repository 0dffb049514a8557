#pragma once

#include "cli/command.h"

namespace simwright::cli {

void AddSceneSearch(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
