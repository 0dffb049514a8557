#pragma once

#include <filesystem>
#include <string>

#include "validation/check_report.h"

namespace simwright::validation {

// Checks the files of an asset folder, rigid or articulated. Throws core::Error if the folder
// cannot be read at all; any other fault is a failed check.
CheckReport CheckAsset(const std::filesystem::path& folder, const CheckLimits& limits = {});

// Checks a URDF of any origin: collision shapes, inertials, and a drop in Bullet with all joints
// held at zero; if every link has an inertial, also that each joint moves through its range. Meshes
// outside `root` are not read; an empty `root` means ReadUrdf's default.
CheckReport CheckUrdf(const std::filesystem::path& urdf, const std::filesystem::path& root,
                      const CheckLimits& limits = {});

// Checks a newly built asset folder before it is kept. Throws as RequirePassed does if the check
// fails; else adds the warnings to the findings in its asset.json.
CheckReport CheckBeforeKeeping(const std::filesystem::path& folder, const std::string& name,
                               const CheckLimits& limits = {});

}  // namespace simwright::validation
