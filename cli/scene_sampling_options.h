#pragma once

#include <filesystem>

#include "cli/command.h"
#include "scene/model/scene_model.h"

namespace simwright::cli {

// Adds the flags of every command that samples a model of scenes: --text-encoder, --steps,
// --eta and --device-noise. The initial value of each variable is the flag's default; the variables
// must outlive `command`.
void AddSceneSamplingOptions(CLI::App* command, std::filesystem::path* text_encoder,
                             scene::SampleOptions* sampling);

}  // namespace simwright::cli
