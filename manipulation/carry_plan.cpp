#include "manipulation/carry_plan.h"

#include <algorithm>
#include <vector>

#include "manipulation/collision_checker.h"
#include "manipulation/gripper_penetration.h"
#include "manipulation/ik_solutions.h"
#include "manipulation/rrt_connect.h"
#include "manipulation/tool_path.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kCarryTurns[] = {0.0,         0.25 * M_PI, -0.25 * M_PI, 0.5 * M_PI,
                                  -0.5 * M_PI, 0.75 * M_PI, -0.75 * M_PI, M_PI};  // rad
constexpr double kPayloadSpacing = 0.016;  // m: twice the thickness of thin boards
// m of arm and payload to objects: the payload swings in the fingers.
constexpr double kCarryClearance = 0.02;
// The number of arrivals for which RRT-Connect is tried if no simple path exists: it is slow.
constexpr size_t kMostSearches = 3;
// The tilt (rad) of a payload that hangs from its rim up to which it does not swing in the fingers.
constexpr double kLevel = 0.4;
constexpr int kTiltSamples = 12;  // of each segment of a path

struct Arrival {
  CarryPlan plan;
  robot::JointVector there;  // (J) with the tool at the destination
};

// Returns the arrivals with the gripper turned by `turn`, the one reached soonest first.
std::vector<Arrival> ArrivalsAt(const PlanningArm& context, const Interaction& interaction,
                                const CarryTask& task, double turn,
                                const robot::JointVector& from) {
  core::Rng rng = core::StreamRng(0, 0);  // deterministic
  Isometry3d there = task.there;
  there.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * there.linear();
  Isometry3d before = there;
  before.translation() += task.back;
  std::vector<IkSolution> configurations =
      SolveIkFromManyStarts(context, interaction, before, from, rng);
  std::sort(configurations.begin(), configurations.end(),
            [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  std::vector<Arrival> arrivals;
  for (const IkSolution& reaching : configurations) {
    CartesianFollower follower(context, interaction, reaching.configuration);
    if (!follower.MoveTo(there)) continue;
    arrivals.push_back({{turn, reaching.configuration, {}}, follower.configuration()});
  }
  return arrivals;
}

// Returns points on the grasped object, in the tool's frame.
SurfacePoints PayloadPoints(const Interaction& interaction, const tasks::WorldState& state) {
  const auto object = static_cast<size_t>(interaction.target->object);
  std::vector<Isometry3d> links =
      tasks::LinkPosesOf(interaction.model.objects[object], state.joints[object]);
  for (Isometry3d& link : links) link = state.gripper.inverse() * state.roots[object] * link;
  return BodySurface(interaction.bodies[object]->body(), links, kPayloadSpacing);
}

// Returns the largest tilt (rad) of a payload, upright at `from`, on the way of `plan`.
double LargestTilt(const PlanningArm& context, const CarryPlan& plan,
                   const robot::JointVector& from, const Vector3d& up_in_base) {
  const robot::Arm& arm = context.robot->arm;
  const auto up_at = [&](const robot::JointVector& at) -> Vector3d {
    return robot::ForwardKinematics(arm, at).linear().transpose() * up_in_base;
  };
  const Vector3d up = up_at(from);  // in the tool's frame
  JointPath path = plan.waypoints;
  path.push_back(plan.arrival);
  robot::JointVector before = from;
  double least = 1.0;  // cosine
  for (const robot::JointVector& next : path) {
    for (int i = 1; i <= kTiltSamples; ++i) {
      const double share = static_cast<double>(i) / kTiltSamples;
      least = std::min(least, up.dot(up_at(before + share * (next - before))));
    }
    before = next;
  }
  return std::acos(std::clamp(least, -1.0, 1.0));
}

// Keeps the plan that tilts its payload the least beyond kLevel; of two alike the first.
class LevelPlan {
 public:
  // The tilt matters where the target hangs from its rim; else all plans are level.
  LevelPlan(const PlanningArm& context, const Interaction& interaction,
            const robot::JointVector& from)
      : context_(context),
        from_(from),
        up_in_base_(interaction.subtask.start.world_from_robot.linear().transpose() *
                    Vector3d::UnitZ()),
        matters_(interaction.target->rim > 0.0) {}

  // Returns true if the plan is level.
  bool Add(const CarryPlan& plan) {
    const double tilt =
        matters_ ? std::max(0.0, LargestTilt(context_, plan, from_, up_in_base_) - kLevel) : 0.0;
    if (!best_ || tilt < tilt_) {
      best_ = plan;
      tilt_ = tilt;
    }
    return tilt == 0.0;
  }
  const std::optional<CarryPlan>& best() const { return best_; }
  bool IsBetterThan(const LevelPlan& other) const { return tilt_ < other.tilt_; }

 private:
  const PlanningArm& context_;
  const robot::JointVector& from_;
  Vector3d up_in_base_;
  bool matters_;
  std::optional<CarryPlan> best_;
  double tilt_ = 0.0;  // rad beyond kLevel
};

// Returns the best plan with a clearance of `margin` (m). `any` receives a plan without a path if
// it has none yet.
std::optional<CarryPlan> PlanWithMargin(const PlanningArm& context, const Interaction& interaction,
                                        const tasks::WorldState& state, const CarryTask& task,
                                        const robot::JointVector& from, double margin,
                                        std::optional<CarryPlan>* any) {
  CollisionChecker clearance(context, interaction, state, interaction.target->object);
  clearance.SetPayload(PayloadPoints(interaction, state));
  LevelPlan straight(context, interaction, from);
  LevelPlan around(context, interaction, from);  // through waypoints
  std::vector<CarryPlan> blocked;                // not reachable by simple waypoints
  const auto stay_clear = [&](const CarryPlan& plan) {
    if (margin > 0.0) clearance.SetClearance(margin, {from, plan.arrival});
  };
  for (const double turn : kCarryTurns) {
    if (turn != 0.0 && !task.may_turn) break;
    for (const Arrival& arrival : ArrivalsAt(context, interaction, task, turn, from)) {
      if (!*any) *any = arrival.plan;
      if (!clearance.IsCollisionFree(arrival.there)) continue;
      stay_clear(arrival.plan);
      const auto path = PlanSimplePath(context, clearance, from, arrival.plan.arrival);
      if (path && path->empty() && straight.Add(arrival.plan)) return arrival.plan;
      if (!path && blocked.size() < kMostSearches &&
          clearance.IsCollisionFree(arrival.plan.arrival)) {
        blocked.push_back(arrival.plan);
      }
      if (!path || path->empty()) continue;
      CarryPlan plan = arrival.plan;
      plan.waypoints = *path;
      around.Add(plan);
    }
  }
  if (around.best() && (!straight.best() || around.IsBetterThan(straight))) return around.best();
  if (straight.best()) return straight.best();
  for (CarryPlan& plan : blocked) {
    stay_clear(plan);
    const auto path = PlanRrtConnect(context.robot->arm, clearance, from, plan.arrival);
    if (!path) continue;
    plan.waypoints = *path;
    return plan;
  }
  return std::nullopt;
}

}  // namespace

std::optional<CarryPlan> PlanCarry(const PlanningArm& context, const Interaction& interaction,
                                   const tasks::WorldState& state, const CarryTask& task,
                                   const robot::JointVector& from) {
  std::optional<CarryPlan> any;
  for (const double margin : {kCarryClearance, 0.0}) {
    if (auto plan = PlanWithMargin(context, interaction, state, task, from, margin, &any)) {
      return plan;
    }
  }
  return any;
}

}  // namespace simwright::manipulation
