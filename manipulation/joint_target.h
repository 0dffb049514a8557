#pragma once

#include "tasks/articulated_object.h"

namespace simwright::manipulation {

// Returns the joint target for a joint at `position`: the farther of its rest position and 80 % of
// its range from there.
double JointTarget(const tasks::ObjectJoint& joint, double position);

}  // namespace simwright::manipulation
