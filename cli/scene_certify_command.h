#pragma once

#include "cli/command.h"

namespace simwright::cli {

// Adds `simwright scene certify`.
void AddSceneCertify(CLI::App* scene, CommonOptions* common, Run* run);

}  // namespace simwright::cli
