#pragma once

#include <cstdint>
#include <filesystem>

#include "core/camera.h"
#include "core/image.h"
#include "core/progress.h"
#include "twin/object_detector.h"
#include "twin/table_pose.h"
#include "workflows/twin/twin_record.h"

namespace simwright::workflows {

// Replaces the asset of a fitted object by a reconstruction of its shape from the photo, as
// `simwright lift --shape free --fast` makes it, with the fitted height. `pose`: the fitted one,
// whose place the reconstruction takes, turned as the photo shows it; `folder`: of the asset.
// Changes neither the entry nor the folder, and throws core::Error, where the reconstruction fails.
void LiftTwinObject(const core::Image& photo, const twin::Detection& detection,
                    const core::Camera& camera, const twin::TablePose& pose, std::uint64_t seed,
                    const std::filesystem::path& folder, TwinObject* entry,
                    core::Progress* progress);

}  // namespace simwright::workflows
