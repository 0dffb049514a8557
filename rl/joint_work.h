#pragma once

#include "tasks/thing.h"

namespace simwright::rl {

// Returns the joint target for a joint at `position`: the farther of its rest position and 80 % of
// its range from there.
double WorkEnd(const tasks::ThingJoint& joint, double position);

}  // namespace simwright::rl
