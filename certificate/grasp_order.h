#pragma once

#include <vector>

#include "certificate/motion_plan.h"
#include "certificate/robot_clearance.h"

namespace simwright::certificate {

// Returns the grasps of the target, as indices into `grasps`, at which the open gripper hits no
// object, neither there nor on the last centimetres of the approach, proved ones first, and of
// these and of the others the most promising first: the directions of approach alternate, so that
// grasps that fail alike do not come one after the other. `clearance` ignores the target and counts
// the hits.
std::vector<size_t> OrderGrasps(const std::vector<Grasp>& grasps, const PlacedBody& target,
                                const Eigen::Isometry3d& world_from_robot, double standoff,
                                RobotClearance* clearance, SearchCounts* counts);

}  // namespace simwright::certificate
