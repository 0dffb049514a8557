#pragma once

#include <vector>

#include "manipulation/grasp.h"
#include "manipulation/interaction.h"

namespace simwright::manipulation {

// Returns `approaches`, the most natural first, each after the proved grasps that are like it:
// within 30 degrees and at most 3 mm shallower, the best quality and then the nearest first, at
// most four. Frames: the link's.
std::vector<Eigen::Isometry3d> WithProvedGrasps(const std::vector<Eigen::Isometry3d>& approaches,
                                                const std::vector<Grasp>& grasps);

// Returns the approach pose (a candidate of InteractionTarget::approaches) for a part that a joint
// moves: the first one with which the open gripper is collision-free from the joint's rest position
// to the joint target and points neither back at the robot nor upwards. Without such a one, returns
// the candidate that comes closest to that.
Eigen::Isometry3d ChooseApproach(const robot::RobotModel& robot, const Interaction& interaction);

}  // namespace simwright::manipulation
