#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "manipulation/collision_checker.h"
#include "manipulation/interaction.h"
#include "manipulation/joint_path.h"

namespace simwright::manipulation {

// The tilt (rad) up to which an object that hangs from its rim does not swing in the fingers.
constexpr double kLevelTilt = 0.4;

// Returns the largest tilt (rad) of the tool on the joint path from `from` (J) through `path` (J
// each): the angle between the world's vertical and the tool's axis that is vertical at `from`.
double LargestTilt(const PlanningArm& context, const Interaction& interaction,
                   const robot::JointVector& from, const JointPath& path);

// The end of a level path.
struct LevelGoal {
  Eigen::Isometry3d world_from_tool;               // m
  std::vector<robot::JointVector> configurations;  // (J) each, suitable ones with the tool there
  // Returns true if another configuration (J) with the tool there is suitable, too.
  std::function<bool(const robot::JointVector&)> is_suitable;  // must be set
};

// Plans a collision-free joint path from `from` (J) to a goal, along which the tool tilts by at
// most kLevelTilt. The tool rises, moves straight towards the robot's axis, around it and outwards
// again, and turns about the vertical on the way; several heights and distances from the axis are
// tried. If the arm cannot follow to the end, a straight joint-space segment leads from the last
// pose that it reached to one of the goal's configurations. `clearance` judges collisions of the
// arm and of its payload, if it has one. Returns the waypoints (J) with the end; none if no such
// path is found.
std::optional<JointPath> PlanLevelPath(const PlanningArm& context, const Interaction& interaction,
                                       const CollisionChecker& clearance,
                                       const robot::JointVector& from, const LevelGoal& goal);

}  // namespace simwright::manipulation
