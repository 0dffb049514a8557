#pragma once

#include <filesystem>

#include "validation/check_report.h"

namespace simwright::validation {

// Implements CheckAsset for a folder whose asset.json says `articulated`.
CheckReport CheckArticulatedAsset(const std::filesystem::path& folder, const CheckLimits& limits);

}  // namespace simwright::validation
