#pragma once

#include <Eigen/Geometry>

#include "tasks/world_state.h"

namespace simwright::manipulation {

// Returns world_from_link of an object's link in `state`.
Eigen::Isometry3d WorldFromLink(const tasks::WorldModel& model, const tasks::WorldState& state,
                                int object, int link);

}  // namespace simwright::manipulation
