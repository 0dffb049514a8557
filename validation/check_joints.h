#pragma once

#include <filesystem>

#include "assets/urdf_reader.h"
#include "sim/articulated_body.h"
#include "validation/check_report.h"
#include "validation/check_results.h"

namespace simwright::validation {

// Adds the check results of an asset's joints (docs/formats.md). The functions may run
// concurrently. They add excluded-pairs, clearance-* and above-floor-*; and in Bullet and, from
// `mjcf`, in MuJoCo swings-*, holds-* and, for a free-standing asset, tips-*.
void AddClearanceResults(const assets::UrdfModel& model, bool fixed, CheckResults* results);
void AddJointResultsInBullet(const assets::UrdfModel& model, bool fixed, const CheckLimits& limits,
                             CheckResults* results);
void AddJointResultsInMujoco(const assets::UrdfModel& model, const std::filesystem::path& mjcf,
                             bool fixed, const CheckLimits& limits, CheckResults* results);

// Adds the joint results of a URDF of any origin. Each joint must reach both limits in Bullet, with
// links passing through each other; clearances and drifts are only reported. Adds nothing if no
// joint moves, and a single result that says so if a link lacks its inertial.
void AddJointResultsOfUrdf(const assets::UrdfModel& model, CheckResults* results);

}  // namespace simwright::validation
