#pragma once

#include <filesystem>

#include "validation/check_report.h"

namespace simwright::workflows {

// Checks an asset folder as validation::CheckAsset does. A rigid asset is then examined for
// simulation: validation::AddSimReadyExam, and its grasps by the Panda's gripper (AddGraspRows).
// Those of an articulated asset are checked geometrically, and its joints move through their range
// and back in both engines, so that CheckAsset already examines it. Throws as CheckAsset does.
validation::CheckReport CheckSimReady(const std::filesystem::path& folder,
                                      const validation::CheckLimits& limits = {});

}  // namespace simwright::workflows
