#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/capture.h"

namespace simwright::workflows {

// Returns the photo files as a capture's source, with their names and EXIF focal lengths. `photos`
// must outlive it. Throws core::Error if a file cannot be read.
capture::CaptureSource SourceOf(const std::vector<std::filesystem::path>& photos);

// Returns `source`, the words for the photos in the asset's record; if it is empty, their number.
std::string NamedOr(const std::string& source, const std::vector<std::filesystem::path>& photos);

}  // namespace simwright::workflows
