#pragma once

#include <filesystem>

#include "assets/urdf_reader.h"
#include "pipeline/check.h"
#include "pipeline/check_rows.h"
#include "sim/articulated_body.h"

namespace simwright::pipeline {

// Rows of an asset's joints (docs/formats.md), which may be made at the same time: excluded-pairs,
// clearance-* and above-floor-*; and in Bullet and, by `mjcf`, in MuJoCo swings-*, holds-*, and for
// one that stands free tips-*.
void AddClearanceRows(const assets::UrdfModel& model, bool fixed, CheckRows* rows);
void AddJointRowsInBullet(const assets::UrdfModel& model, bool fixed, const CheckLimits& limits,
                          CheckRows* rows);
void AddJointRowsInMujoco(const assets::UrdfModel& model, const std::filesystem::path& mjcf,
                          bool fixed, const CheckLimits& limits, CheckRows* rows);

// For a URDF of any origin: each joint reaches both ends in Bullet, links passing through each
// other; clearances and drifts are reported alone. No rows where nothing moves; one that says so
// where a link lacks its inertial.
void AddJointRowsOfUrdf(const assets::UrdfModel& model, CheckRows* rows);

}  // namespace simwright::pipeline
