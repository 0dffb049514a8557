#pragma once

#include <filesystem>

#include "workflows/scenes/scene_post_training.h"

namespace simwright::workflows {

// The file of a post-training's folder with the settings that a resumed run must have too.
inline constexpr char kPostTrainingSettingsFile[] = "settings.json";

// Writes the settings of a run.
void WritePostTrainingSettings(const ScenePostTrainingRequest& request,
                               const std::filesystem::path& weights);

// Throws core::Error if a run in the folder of `request` had other settings, naming the first one
// that differs. The rate, the clip, the weight of the data's loss, the number of rounds and the
// checkpoints may differ. Accepts a folder without the file.
void CheckPostTrainingSettings(const ScenePostTrainingRequest& request,
                               const std::filesystem::path& weights);

}  // namespace simwright::workflows
