#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "viewer/content.h"

namespace simwright::viewer {

// Returns the content of a dataset of scenes (a folder of shards, or one shard). Scenes are read
// when they are shown. Throws core::Error if it has none, or an asset is missing or damaged.
std::unique_ptr<Content> ReadDatasetView(const std::filesystem::path& path);

// Returns the content of scenes in the forms that ReadSceneSource reads, one entry each. Throws
// core::Error as it does.
std::unique_ptr<Content> ReadScenesView(const std::vector<std::filesystem::path>& paths,
                                        const std::string& title);

}  // namespace simwright::viewer
