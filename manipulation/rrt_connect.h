#pragma once

#include <optional>

#include "manipulation/joint_path.h"
#include "manipulation/path_checker.h"
#include "robot/arm.h"

namespace simwright::manipulation {

// Plans a collision-free joint path from `from` to `to` (J) by RRT-Connect (Kuffner and LaValle
// 2000): two trees grow towards each other from both ends, and the path is then shortcut.
// Deterministic for the same ends. `from` is assumed to be collision-free. None if `to` is not, or
// if `rounds` rounds find no path, or only one with more than a dozen waypoints.
std::optional<JointPath> PlanRrtConnect(const robot::Arm& arm, const PathChecker& clearance,
                                        const robot::JointVector& from,
                                        const robot::JointVector& to, int rounds = 600);

}  // namespace simwright::manipulation
