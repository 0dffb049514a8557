#pragma once

#include "tasks/thing.h"

namespace simwright::rl {

// How far a joint that stands at `position` shall go: the farther of its rest and most of its way.
double WorkEnd(const tasks::ThingJoint& joint, double position);

}  // namespace simwright::rl
