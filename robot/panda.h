#pragma once

#include "robot/arm.h"

namespace simwright::robot {

// Franka Emika's Panda, its tool between the fingertips (hand_tcp: z along the approach, y from
// finger to finger). Joint origins and limits: franka_description, robots/fer (Apache-2.0).
const Arm& PandaArm();

// m between the fingers of its hand when they are open.
constexpr double kPandaOpening = 0.08;

}  // namespace simwright::robot
