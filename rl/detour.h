#pragma once

#include <optional>
#include <vector>

#include "rl/arm_clearance.h"
#include "rl/skill.h"

namespace simwright::rl {

// Postures (J) that an arm goes through on its way from one to another, straight from joint to
// joint between them.
using Detour = std::vector<robot::Posture>;

// How the arm gets from `from` to `to` (J) and is in nothing: straight, where that is clear (an
// empty detour), else folded as at home before it turns, after it has turned, or both, or by home
// itself. None where none of these is clear.
std::optional<Detour> PlanDetour(const Skill& skill, const ArmClearance& clearance,
                                 const robot::Posture& from, const robot::Posture& to);

}  // namespace simwright::rl
