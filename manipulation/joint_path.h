#pragma once

#include <optional>
#include <vector>

#include "manipulation/collision_checker.h"
#include "manipulation/interaction.h"

namespace simwright::manipulation {

// Waypoints (J) of a joint path, without its ends, connected by straight joint-space segments.
using JointPath = std::vector<robot::JointVector>;

// Returns the waypoints of a collision-free joint path from `from` to `to` (J): none for the
// straight segment, else the first collision-free combination of folding the arm as at home before
// the first rotary joint turns, folding it after, and home. Returns nullopt if none of these paths
// is collision-free.
std::optional<JointPath> PlanSimplePath(const PlanningArm& context,
                                        const CollisionChecker& clearance,
                                        const robot::JointVector& from,
                                        const robot::JointVector& to);

}  // namespace simwright::manipulation
