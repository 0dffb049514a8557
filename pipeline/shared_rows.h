#pragma once

#include <functional>
#include <string>

#include "assets/asset.h"
#include "pipeline/check.h"
#include "pipeline/check_rows.h"
#include "sim/drop_test.h"

// Rows that the checks of rigid and of articulated assets share.
namespace simwright::pipeline {

constexpr double kDegrees = 57.295779513082320877;  // in a radian

// Largest relative difference of mass, centre (against `size`, m) and inertia.
double InertialDifference(const assets::Inertial& a, const assets::Inertial& b, double size);

// Runs one reader; the core::Error it throws is the failure of row `code`.
void RowOrFailure(const std::string& code, CheckRows* rows, const std::function<void()>& load);

// settles-*, rest-pose-*, drift-* and sinks-*, or of a body that rolls rolls-* and sinks-*, its
// diagonal being `size` (m).
void AddRestRows(const sim::DropResult& drop, const std::string& engine, bool rolls, double size,
                 const CheckLimits& limits, CheckRows* rows);

// settles-* reported, rest-pose-* with wider limits, drift-* and sinks-*, of a body that no pose
// held when it was made and that does not roll.
void AddRockingRows(const sim::DropResult& drop, const std::string& engine, double size,
                    const CheckLimits& limits, CheckRows* rows);

}  // namespace simwright::pipeline
