#include "manipulation/goal_placement.h"

#include "manipulation/side_receptacle.h"

namespace simwright::manipulation {
namespace {

constexpr double kHandBeside = 0.08;  // m, space for the gripper around the object
constexpr double kHandAbove = 0.15;   // m

// Returns true if the object with the gripper on it, displaced by `displacement`, would intersect
// another object.
bool IsBlocked(const Interaction& interaction, const tasks::WorldState& state, int object,
               const Eigen::Vector3d& displacement) {
  Eigen::AlignedBox3d there =
      tasks::WorldAabb(interaction.model, state, object).translated(displacement);
  there.min() -= Eigen::Vector3d(kHandBeside, kHandBeside, 0.0);
  there.max() += Eigen::Vector3d(kHandBeside, kHandBeside, kHandAbove);
  for (const int other : interaction.placed) {
    if (other == object) continue;
    if (there.intersects(tasks::WorldAabb(interaction.model, state, other))) return true;
  }
  return false;
}

}  // namespace

Eigen::Vector3d GoalIn(const Interaction& interaction, const tasks::WorldState& state) {
  const Eigen::Vector3d& goal = interaction.start.goal;
  const bool lifts = interaction.target && interaction.target->joint < 0 &&
                     interaction.asks_for_grasp && interaction.destination &&
                     interaction.destination->goal && !interaction.starts_held;
  if (!lifts) return goal;
  const int object = interaction.target->object;
  const Eigen::Vector3d described =
      tasks::LinkPosition(interaction.model, interaction.start, object, 0);
  if (const auto room = FindSideReceptacleAround(interaction.model, interaction.start, described)) {
    const auto holder = static_cast<size_t>(room->object);
    return state.roots[holder] * (interaction.start.roots[holder].inverse() * goal);
  }
  const Eigen::Vector3d now = tasks::LinkPosition(interaction.model, state, object, 0);
  if (!IsBlocked(interaction, state, object, goal - now)) return goal;
  return now + Eigen::Vector3d(0.0, 0.0, goal.z() - described.z());
}

}  // namespace simwright::manipulation
