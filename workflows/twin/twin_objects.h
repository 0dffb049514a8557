#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/camera.h"
#include "core/finding.h"
#include "core/image.h"
#include "core/progress.h"
#include "twin/object_detector.h"
#include "twin/table_reconstruction.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// Writes an asset folder, below `folder`, for each object of a reconstruction: the fitted object of
// the library, painted by the photo where it shows its surface. Returns the objects with the poses
// of their assets. Objects whose asset cannot be made are left out, with a finding. `photo` (RGB)
// and `detections` are those of the reconstruction.
std::vector<TwinObject> WriteTwinAssets(const twin::TableReconstruction& table,
                                        const core::Image& photo,
                                        const twin::Detections& detections, std::uint64_t seed,
                                        const std::filesystem::path& folder,
                                        core::Progress* progress, core::Findings* findings);

}  // namespace simwright::workflows
