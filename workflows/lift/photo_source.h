#pragma once

#include <filesystem>
#include <vector>

#include "capture/capture.h"

namespace simwright::workflows {

// Returns the photo files as a capture's source, with their names and EXIF focal lengths. `photos`
// must outlive it. Throws core::Error if a file cannot be read.
capture::CaptureSource SourceOf(const std::vector<std::filesystem::path>& photos);

}  // namespace simwright::workflows
