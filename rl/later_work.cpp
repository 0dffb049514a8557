#include "rl/later_work.h"

#include "rl/goal_placement.h"
#include "rl/reach_plan.h"

namespace simwright::rl {
namespace {

constexpr double kSamePlace = 0.01;  // m: an object farther off was carried

// Returns true if `later` finds its object where the task begins with it.
bool IsWhereItWas(const SkillVariant& later, const SkillVariant& first) {
  const auto thing = static_cast<size_t>(later.focus->thing);
  const Eigen::Isometry3d& root = later.start.roots[thing];
  return (root.translation() - first.start.roots[thing].translation()).norm() < kSamePlace;
}

}  // namespace

bool IsLaterWorkInReach(const Skill& skill, int variant, const tasks::SceneState& state,
                        core::Rng& rng) {
  const SkillVariant& first = skill.variants[static_cast<size_t>(variant)];
  for (const auto& next : skill.later) {
    const SkillVariant& later = next->variants[static_cast<size_t>(variant)];
    if (!later.focus || later.starts_held || !IsWhereItWas(later, first)) continue;
    tasks::SceneState then = state;
    then.joints = later.start.joints;
    then.goal = GoalIn(later, then);
    const auto plan = PlanReach(*next, later, then, skill.robot->home(), rng, {.round = true});
    if (!plan || !plan->GetsThere() || (later.next && !plan->goes_on)) return false;
  }
  return true;
}

}  // namespace simwright::rl
