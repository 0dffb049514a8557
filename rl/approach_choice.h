#pragma once

#include "rl/skill.h"

namespace simwright::rl {

// How the hand comes to a part that a joint moves: the first of focus.approaches with which it is
// in nothing's way from the joint's rest to the end of its work, fingers open, and points neither
// back at the robot nor up, as a hand that takes a lid from above would in the end; else the one
// that comes nearest to that. `body`: of the focus' thing.
Eigen::Isometry3d ChooseApproach(const robot::RobotModel& robot, const SkillVariant& variant,
                                 const sim::ArticulatedBody& body);

}  // namespace simwright::rl
