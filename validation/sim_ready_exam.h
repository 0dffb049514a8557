#pragma once

#include <filesystem>

#include "assets/asset.h"
#include "validation/check_report.h"
#include "validation/check_results.h"

namespace simwright::validation {

// Adds the results of the sim-ready exam of a rigid asset, in Bullet and, from its MJCF file, in
// MuJoCo. A row that does not apply to the asset says why and passes.
//   drop-far-*    dropped from 10 cm: it comes to rest, or rolls and slows down, above the floor
//   slope-*       on a slope of 80 % of its friction angle (or 70 % of its tipping angle), in four
//                 directions: it stays
//   slides-*      on a slope of 130 % of its friction angle: it slides as Coulomb's law says,
//                 a = g (sin(angle) - friction cos(angle))
//   stack-*       on a free crate, with a plate of half its mass on it if its top bears one: all
//                 stay
void AddSimReadyExam(const assets::Asset& asset, const std::filesystem::path& folder,
                     const CheckLimits& limits, CheckResults* results);

}  // namespace simwright::validation
