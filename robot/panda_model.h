#pragma once

#include "robot/robot_model.h"

namespace simwright::robot {

// robots/panda/panda.urdf, or panda_on_base.urdf where `on_base`, from what is compiled in. Read
// at the first call; the same object ever after.
const RobotModel& Panda(bool on_base);

}  // namespace simwright::robot
