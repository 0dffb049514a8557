#include "skills/downstream_reachability.h"

#include "manipulation/goal_placement.h"
#include "manipulation/reach_plan.h"

namespace simwright::skills {
namespace {

constexpr double kSamePlace = 0.01;  // m: an object farther off was carried

// Returns true if `later` finds its object where the task begins with it.
bool IsWhereItWas(const SkillVariant& later, const SkillVariant& first) {
  const auto object = static_cast<size_t>(later.target->object);
  const Eigen::Isometry3d& root = later.start.roots[object];
  return (root.translation() - first.start.roots[object].translation()).norm() < kSamePlace;
}

}  // namespace

bool IsDownstreamReachable(const Skill& skill, int variant, const tasks::WorldState& state,
                           core::Rng& rng) {
  const SkillVariant& first = skill.variants[static_cast<size_t>(variant)];
  for (const auto& next : skill.later_skills) {
    const SkillVariant& later = next->variants[static_cast<size_t>(variant)];
    if (!later.target || later.starts_held || !IsWhereItWas(later, first)) continue;
    tasks::WorldState then = state;
    then.joints = later.start.joints;
    then.goal = manipulation::GoalIn(later, then);
    const auto plan =
        manipulation::PlanReach(*next, later, then, skill.robot->home(), rng, {.round = true});
    if (!plan || !plan->IsReachable() || (later.next && !plan->reaches_next)) return false;
  }
  return true;
}

}  // namespace simwright::skills
