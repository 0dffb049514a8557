#pragma once

#include <filesystem>

#include "capture/capture.h"

namespace simwright::workflows {

// Writes into `folder`: capture.json (lenses and camera poses, docs/formats.md), capture.png (the
// photos with their masks) and capture.html (a table of the photos with reprojection error and
// direction, the findings, and the directions from which photos are missing).
void WriteCaptureReport(const capture::CaptureSource& source, const capture::Capture& capture,
                        const std::filesystem::path& folder);

}  // namespace simwright::workflows
