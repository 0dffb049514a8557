#include "rl/goal_placement.h"

#include "rl/side_room.h"

namespace simwright::rl {
namespace {

constexpr double kHandBeside = 0.08;  // m, space for the gripper around the object
constexpr double kHandAbove = 0.15;   // m

// Returns true if the object with the gripper on it, displaced by `displacement`, would intersect another
// object.
bool IsBlocked(const SkillVariant& variant, const tasks::SceneState& state, int thing,
               const Eigen::Vector3d& displacement) {
  Eigen::AlignedBox3d there = tasks::WorldBox(variant.model, state, thing).translated(displacement);
  there.min() -= Eigen::Vector3d(kHandBeside, kHandBeside, 0.0);
  there.max() += Eigen::Vector3d(kHandBeside, kHandBeside, kHandAbove);
  for (const int other : variant.placed) {
    if (other == thing) continue;
    if (there.intersects(tasks::WorldBox(variant.model, state, other))) return true;
  }
  return false;
}

}  // namespace

Eigen::Vector3d GoalIn(const SkillVariant& variant, const tasks::SceneState& state) {
  const Eigen::Vector3d& goal = variant.start.goal;
  const bool lifts = variant.focus && variant.focus->joint < 0 && variant.asks_for_grasp &&
                     variant.destination && variant.destination->goal && !variant.starts_held;
  if (!lifts) return goal;
  const int thing = variant.focus->thing;
  const Eigen::Vector3d described = tasks::LinkPoint(variant.model, variant.start, thing, 0);
  if (const auto room = SideRoomAround(variant.model, variant.start, described)) {
    const auto holder = static_cast<size_t>(room->thing);
    return state.roots[holder] * (variant.start.roots[holder].inverse() * goal);
  }
  const Eigen::Vector3d now = tasks::LinkPoint(variant.model, state, thing, 0);
  if (!IsBlocked(variant, state, thing, goal - now)) return goal;
  return now + Eigen::Vector3d(0.0, 0.0, goal.z() - described.z());
}

}  // namespace simwright::rl
