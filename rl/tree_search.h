#pragma once

#include <optional>

#include "rl/arm_clearance.h"
#include "rl/detour.h"

namespace simwright::rl {

// How the arm gets from `from` to `to` (J), in nothing, by two trees of postures that grow towards
// each other from both ends (RRT-Connect, Kuffner and LaValle 2000), its way then cut short where
// that is clear. The same ends have the same way. `from` is taken to be clear. None where `to` is
// not, or where no way is found in 600 rounds, or only one of more than a dozen postures.
std::optional<Detour> SearchDetour(const robot::Arm& arm, const ArmClearance& clearance,
                                   const robot::Posture& from, const robot::Posture& to);

}  // namespace simwright::rl
