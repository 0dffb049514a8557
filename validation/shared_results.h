#pragma once

#include <functional>
#include <string>

#include "assets/asset.h"
#include "sim/drop_test.h"
#include "validation/check_report.h"
#include "validation/check_results.h"

// Results that the checks of rigid and articulated assets share.
namespace simwright::validation {

constexpr double kDegrees = 57.295779513082320877;  // per radian

// Returns the largest relative difference of mass, centre of mass (relative to `size`, m) and
// inertia.
double InertialDifference(const assets::Inertial& a, const assets::Inertial& b, double size);

// Runs one reader. If it throws core::Error, adds the error as a failed check `code`.
void AddResultOrFailure(const std::string& code, CheckResults* results,
                        const std::function<void()>& load);

// Adds settles-*, rest-pose-*, drift-* and sinks-*, or for a rolling body rolls-* and sinks-*.
// `size` is the body's diagonal (m).
void AddRestResults(const sim::DropResult& drop, const std::string& engine, bool rolls, double size,
                    const CheckLimits& limits, CheckResults* results);

// Adds the results of a body that no pose held when it was built and that does not roll: settles-*
// (only reported), rest-pose-* (with wider limits), drift-* and sinks-*.
void AddRockingResults(const sim::DropResult& drop, const std::string& engine, double size,
                       const CheckLimits& limits, CheckResults* results);

}  // namespace simwright::validation
