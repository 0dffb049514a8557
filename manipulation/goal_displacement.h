#pragma once

#include <Eigen/Core>

#include "manipulation/interaction.h"

namespace simwright::manipulation {

// The displacement (m, world) from the interaction's target to `destination`.
Eigen::Vector3d DisplacementTo(const Destination& destination, const Interaction& interaction,
                               const tasks::WorldState& state);

// The same to the interaction's own destination, which it must have.
Eigen::Vector3d DisplacementToDestination(const Interaction& interaction,
                                          const tasks::WorldState& state);

}  // namespace simwright::manipulation
