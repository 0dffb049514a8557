#pragma once

#include <filesystem>
#include <memory>

#include "viewer/content.h"

namespace simwright::viewer {

// Recognises `path` and reads it as the content of a page. Throws core::Error, listing what can be
// shown, for a path that is none of them, and if it is damaged.
std::unique_ptr<Content> ReadViewContent(const std::filesystem::path& path);

// Returns the source of the same content, which is read again when its files change. The log and
// the checkpoints of trainings do not count: their curves are read on their own.
ContentSource ViewSource(const std::filesystem::path& path);

}  // namespace simwright::viewer
