#pragma once

#include <optional>
#include <vector>

#include "rl/arm_clearance.h"
#include "rl/skill.h"

namespace simwright::rl {

// Waypoints (J) of a joint path, without its ends, connected by straight joint-space segments.
using Detour = std::vector<robot::Posture>;

// Returns the waypoints of a collision-free joint path from `from` to `to` (J): none for the
// straight segment, else the first collision-free combination of folding the arm as at home before
// the first rotary joint turns, folding it after, and home. Returns nullopt if none of these paths
// is collision-free.
std::optional<Detour> PlanDetour(const Skill& skill, const ArmClearance& clearance,
                                 const robot::Posture& from, const robot::Posture& to);

}  // namespace simwright::rl
