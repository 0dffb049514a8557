#include "robot/joint_limits.h"

namespace simwright::robot {

JointLimits CommandLimits(const JointLimits& limits, const LimitMargin& margin) {
  JointLimits command = limits;
  command.velocity -= margin.absolute + margin.delay * limits.acceleration;
  command.acceleration -= margin.absolute;
  command.jerk -= margin.absolute;
  return command;
}

}  // namespace simwright::robot
