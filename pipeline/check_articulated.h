#pragma once

#include <filesystem>

#include "pipeline/check.h"

namespace simwright::pipeline {

// Implements CheckAsset for a folder whose asset.json says `articulated`.
CheckReport CheckArticulatedAsset(const std::filesystem::path& folder, const CheckLimits& limits);

}  // namespace simwright::pipeline
