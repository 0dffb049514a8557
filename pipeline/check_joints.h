#pragma once

#include <filesystem>

#include "assets/urdf_reader.h"
#include "pipeline/check.h"
#include "pipeline/check_rows.h"
#include "sim/articulated_body.h"

namespace simwright::pipeline {

// Rows of an asset's joints, in Bullet and, by `mjcf`, in MuJoCo: clearance-*, swings-*, holds-*,
// and for one that stands free tips-* (docs/formats.md).
void AddJointRows(const assets::UrdfModel& model, const std::filesystem::path& mjcf, bool fixed,
                  const CheckLimits& limits, CheckRows* rows);

// For a URDF of any origin: each joint reaches both ends in Bullet, links passing through each
// other; clearances and drifts are reported alone. No rows where nothing moves; one that says so
// where a link lacks its inertial.
void AddJointRowsOfUrdf(const assets::UrdfModel& model, CheckRows* rows);

}  // namespace simwright::pipeline
