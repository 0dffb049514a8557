#include "rl/carry_plan.h"

#include <algorithm>
#include <vector>

#include "rl/arm_clearance.h"
#include "rl/posture_search.h"
#include "rl/tool_follower.h"
#include "rl/tree_search.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTurns[] = {0.0,         0.25 * M_PI, -0.25 * M_PI, 0.5 * M_PI,
                             -0.5 * M_PI, 0.75 * M_PI, -0.75 * M_PI, M_PI};  // rad
// The number of arrivals for which RRT-Connect is tried if no simple path exists: it is slow.
constexpr size_t kMostSearches = 3;

struct Arrival {
  CarryPlan plan;
  robot::Posture there;  // (J) with the tool at the destination
};

// Returns the arrivals with the gripper turned by `turn`, the one reached soonest first.
std::vector<Arrival> ArrivalsAt(const Skill& skill, const SkillVariant& variant,
                                const CarryTask& task, double turn, const robot::Posture& from) {
  core::Rng rng = core::StreamRng(0, 0);  // deterministic
  Isometry3d there = task.there;
  there.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * there.linear();
  Isometry3d before = there;
  before.translation() += task.back;
  std::vector<ReachingPosture> postures = PosturesAt(skill, variant, before, from, rng);
  std::sort(postures.begin(), postures.end(),
            [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  std::vector<Arrival> arrivals;
  for (const ReachingPosture& reaching : postures) {
    ToolFollower follower(skill, variant, reaching.posture);
    if (!follower.Goes(there)) continue;
    arrivals.push_back({{turn, reaching.posture, {}}, follower.posture()});
  }
  return arrivals;
}

// Returns the convex hull points of the grasped object, in the tool's frame.
SurfacePoints PayloadPoints(const SkillVariant& variant, const tasks::SceneState& state) {
  const auto thing = static_cast<size_t>(variant.focus->thing);
  const std::vector<Isometry3d> links =
      tasks::LinkPosesOf(variant.model.things[thing], state.joints[thing]);
  const Isometry3d tool_from_thing = state.gripper.inverse() * state.roots[thing];
  std::vector<Vector3d> points;
  for (size_t l = 0; l < links.size(); ++l) {
    for (const Vector3d& point : variant.model.things[thing].links[l].outline) {
      points.push_back(tool_from_thing * links[l] * point);
    }
  }
  return SurfacePoints(std::move(points));
}

}  // namespace

std::optional<CarryPlan> PlanCarry(const Skill& skill, const SkillVariant& variant,
                                   const tasks::SceneState& state, const CarryTask& task,
                                   const robot::Posture& from) {
  ArmClearance clearance(skill, variant, state, variant.focus->thing);
  clearance.Carry(PayloadPoints(variant, state));
  std::optional<CarryPlan> any, by_waypoints;
  std::vector<CarryPlan> blocked;  // not reachable by simple waypoints
  for (const double turn : kTurns) {
    if (turn != 0.0 && !task.may_turn) break;
    for (const Arrival& arrival : ArrivalsAt(skill, variant, task, turn, from)) {
      if (!any) any = arrival.plan;
      if (!clearance.IsClear(arrival.there)) continue;
      const auto way = PlanDetour(skill, clearance, from, arrival.plan.arrival);
      if (way && way->empty()) return arrival.plan;
      if (!way && blocked.size() < kMostSearches && clearance.IsClear(arrival.plan.arrival)) {
        blocked.push_back(arrival.plan);
      }
      if (!way || by_waypoints) continue;
      by_waypoints = arrival.plan;
      by_waypoints->via = *way;
    }
  }
  if (by_waypoints) return by_waypoints;
  for (CarryPlan& plan : blocked) {
    const auto way = SearchDetour(skill.robot->arm, clearance, from, plan.arrival);
    if (!way) continue;
    plan.via = *way;
    return plan;
  }
  return any;
}

}  // namespace simwright::rl
