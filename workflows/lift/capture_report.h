#pragma once

#include <filesystem>

#include "asset_lift/capture/capture.h"

namespace simwright::workflows {

// Writes into `folder`: capture.json (lenses and camera poses, docs/formats.md), capture.png (the
// photos with their masks) and capture.html (a table of the photos with reprojection error and
// direction, the findings, and the directions from which photos are missing).
void WriteCaptureReport(const asset_lift::CaptureSource& source, const asset_lift::Capture& capture,
                        const std::filesystem::path& folder);

}  // namespace simwright::workflows
