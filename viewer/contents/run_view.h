#pragma once

#include <filesystem>
#include <memory>

#include "viewer/content.h"

namespace simwright::viewer {

// Returns the content of a training's folder: the start of each subtask, the rollouts whose poses
// lie in it, and the learning curves as the logs stand when they are asked for. An episode of the
// policies is recorded on request. Throws core::Error as ReadRun does.
std::unique_ptr<Content> ReadTrainingView(const std::filesystem::path& folder);

// Returns the content of the folder of `simwright run`, which may still be running: the asset, and,
// as far as they exist, the rollout, the tasks and the learning curves.
std::unique_ptr<Content> ReadPhotoRunView(const std::filesystem::path& folder);

// Returns true for a folder of `simwright train`, or of `simwright run`.
bool IsTrainingFolder(const std::filesystem::path& folder);
bool IsPhotoRunFolder(const std::filesystem::path& folder);

}  // namespace simwright::viewer
