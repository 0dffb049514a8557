#pragma once

#include "robot/arm.h"

namespace simwright::robot {

// Returns Franka Emika's Panda. The tool frame lies between the fingertips (hand_tcp: z along the
// approach, y from finger to finger). Joint origins and limits: franka_description, robots/fer
// (Apache-2.0).
const Arm& PandaArm();

// The opening of the gripper between its fingers when open, m.
constexpr double kPandaGripperOpening = 0.08;

}  // namespace simwright::robot
