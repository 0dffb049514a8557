#pragma once

#include <optional>

#include "manipulation/interaction.h"
#include "manipulation/joint_path.h"

namespace simwright::manipulation {

// The joint path by which an arm carries a grasped object to its destination.
struct CarryPlan {
  double turn = 0.0;           // rad about the vertical by which gripper and object turn
  robot::JointVector arrival;  // (J) before the final approach to the destination
  JointPath waypoints;         // waypoints before `arrival`
};

// The input of PlanCarry. Poses are world_from_tool.
struct CarryTask {
  Eigen::Isometry3d there;  // the tool pose with the object at its destination
  Eigen::Vector3d back;     // m, world: from `there` to the pose before the final approach
  bool may_turn = false;    // true if the gripper may arrive turned about the vertical
};

// Plans the joint path from `from` (J) to a destination with the smallest turn about the vertical
// and, among several configurations, the one that is reached soonest. The arm, with the grasped
// object ignored as an obstacle, must be collision-free at the destination and on the path:
// straight, else through waypoints (PlanSimplePath), else by RRT-Connect (PlanRrtConnect). An
// object that hangs from its rim is carried upright if PlanLevelPath finds a path: tilted, it
// swings in the fingers and arrives askew. Paths keep 2 cm of clearance; one without it, level or
// not, is only taken if there is no other. Without a collision-free path, returns a reachable
// arrival; none if no arrival is reachable. A tool that only tracks a straight line to a far
// destination ends at a joint limit or in furniture.
std::optional<CarryPlan> PlanCarry(const PlanningArm& context, const Interaction& interaction,
                                   const tasks::WorldState& state, const CarryTask& task,
                                   const robot::JointVector& from);

}  // namespace simwright::manipulation
