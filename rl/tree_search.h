#pragma once

#include <optional>

#include "rl/arm_clearance.h"
#include "rl/detour.h"

namespace simwright::rl {

// Plans a collision-free joint path from `from` to `to` (J) by RRT-Connect (Kuffner and LaValle
// 2000): two trees grow towards each other from both ends, and the path is then shortcut.
// Deterministic for the same ends. `from` is assumed to be collision-free. None if `to` is not, or
// if 600 rounds find no path, or only one with more than a dozen waypoints.
std::optional<Detour> SearchDetour(const robot::Arm& arm, const ArmClearance& clearance,
                                   const robot::Posture& from, const robot::Posture& to);

}  // namespace simwright::rl
