#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "tasks/world_state.h"

namespace simwright::manipulation {

// Top-opening receptacles, such as bowls and drawers: objects go into them over the rim.

// The clearance (m) of a carried object above the rim.
inline constexpr double kRimClearance = 0.03;

// Returns true if the receptacle opens upwards in `state`.
bool OpensUpwards(const tasks::WorldModel& model, const tasks::WorldState& state, int object,
                  const tasks::Receptacle& receptacle);

// Returns the middle (m, link frame) of the region that is accessible from above: for a drawer that
// is open by less than its length, only of the part that is out.
Eigen::Vector3d PlacementFromAbove(const tasks::WorldModel& model, const tasks::WorldState& state,
                                   int object, const tasks::Receptacle& receptacle);

// Returns the height (m above the floor) of the walls of the top-opening receptacle that contains
// `point` (m, world).
std::optional<double> RimHeightAround(const tasks::WorldModel& model,
                                      const tasks::WorldState& state, const Eigen::Vector3d& point);

}  // namespace simwright::manipulation
