#include "manipulation/goal_displacement.h"

#include <vector>

namespace simwright::manipulation {

Eigen::Vector3d DisplacementTo(const Destination& destination, const Interaction& interaction,
                               const tasks::WorldState& state) {
  Eigen::Vector3d point = state.goal;
  if (!destination.goal) {
    const auto object = static_cast<size_t>(destination.object);
    const std::vector<Eigen::Isometry3d> poses =
        tasks::LinkPosesOf(interaction.model.objects[object], state.joints[object]);
    point = state.roots[object] * poses[static_cast<size_t>(destination.link)] * destination.point;
  }
  return point - tasks::LinkPosition(interaction.model, state, interaction.target->object,
                                     interaction.target->link);
}

Eigen::Vector3d DisplacementToDestination(const Interaction& interaction,
                                          const tasks::WorldState& state) {
  return DisplacementTo(*interaction.destination, interaction, state);
}

}  // namespace simwright::manipulation
