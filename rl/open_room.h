#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tasks/scene_state.h"

namespace simwright::rl {

// Rooms that open upwards, as bowls and drawers have: things go into them over their rim.

// m above a rim that what is carried goes over it.
inline constexpr double kOverRim = 0.03;

// Whether the cavity opens upwards as its thing stands.
bool OpensUpwards(const tasks::SceneModel& model, const tasks::SceneState& state, int thing,
                  const tasks::Cavity& cavity);

// The middle of what can be come at from above, m, the link's frame: of a drawer that stands open
// by less than its length only the part that is out.
Eigen::Vector3d SpotFromAbove(const tasks::SceneModel& model, const tasks::SceneState& state,
                              int thing, const tasks::Cavity& cavity);

// m above the floor, the top of the walls about such a room that `point` (m, world) is in.
std::optional<double> RimAround(const tasks::SceneModel& model, const tasks::SceneState& state,
                                const Eigen::Vector3d& point);

}  // namespace simwright::rl
