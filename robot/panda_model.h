#pragma once

#include "robot/robot_model.h"

namespace simwright::robot {

// Returns the embedded robots/panda/panda.urdf, or panda_on_base.urdf if `on_base`. Parsed at the
// first call; later calls return the same object.
const RobotModel& Panda(bool on_base);

}  // namespace simwright::robot
