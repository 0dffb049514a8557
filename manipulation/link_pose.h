#pragma once

#include <Eigen/Geometry>

#include "tasks/scene_state.h"

namespace simwright::manipulation {

// Returns world_from_link of an object's link in `state`.
Eigen::Isometry3d WorldFromLink(const tasks::SceneModel& model, const tasks::SceneState& state,
                                int object, int link);

}  // namespace simwright::manipulation
