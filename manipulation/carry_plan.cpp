#include "manipulation/carry_plan.h"

#include <algorithm>
#include <vector>

#include "manipulation/collision_checker.h"
#include "manipulation/gripper_penetration.h"
#include "manipulation/ik_solutions.h"
#include "manipulation/level_path.h"
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

struct Arrival {
  CarryPlan plan;
  robot::JointVector there;  // (J) with the tool at the destination
};

// Returns the tool pose at the destination with the gripper turned by `turn`.
Isometry3d PoseAt(const CarryTask& task, double turn) {
  Isometry3d there = task.there;
  there.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * there.linear();
  return there;
}

// Returns the pose before the final approach to PoseAt.
Isometry3d PoseBefore(const CarryTask& task, double turn) {
  Isometry3d before = PoseAt(task, turn);
  before.translation() += task.back;
  return before;
}

// Returns the arrivals with the gripper turned by `turn`, the one reached soonest first.
std::vector<Arrival> ArrivalsAt(const PlanningArm& context, const Interaction& interaction,
                                const CarryTask& task, double turn,
                                const robot::JointVector& from) {
  core::Rng rng = core::StreamRng(0, 0);  // deterministic
  const Isometry3d there = PoseAt(task, turn), before = PoseBefore(task, turn);
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

// Keeps the plan that tilts its payload the least beyond kLevelTilt; of two alike the first.
class LevelPlan {
 public:
  // The tilt matters where the target hangs from its rim; else all plans are level.
  LevelPlan(const PlanningArm& context, const Interaction& interaction,
            const robot::JointVector& from)
      : context_(context),
        interaction_(interaction),
        from_(from),
        matters_(interaction.target->rim > 0.0) {}

  // Returns true if the plan is level.
  bool Add(const CarryPlan& plan) {
    JointPath path = plan.waypoints;
    path.push_back(plan.arrival);
    const double tilt =
        matters_ ? std::max(0.0, LargestTilt(context_, interaction_, from_, path) - kLevelTilt)
                 : 0.0;
    if (!best_ || tilt < tilt_) {
      best_ = plan;
      tilt_ = tilt;
    }
    return tilt == 0.0;
  }
  const std::optional<CarryPlan>& best() const { return best_; }
  bool IsLevel() const { return best_ && tilt_ == 0.0; }
  bool matters() const { return matters_; }
  bool IsBetterThan(const LevelPlan& other) const { return tilt_ < other.tilt_; }

 private:
  const PlanningArm& context_;
  const Interaction& interaction_;
  const robot::JointVector& from_;
  bool matters_;
  std::optional<CarryPlan> best_;
  double tilt_ = 0.0;  // rad beyond kLevelTilt
};

// Searches the best plan with one clearance.
class CarrySearch {
 public:
  // `margin`: m of clearance. All arguments must outlive this.
  CarrySearch(const PlanningArm& context, const Interaction& interaction,
              const tasks::WorldState& state, const CarryTask& task, const robot::JointVector& from,
              double margin)
      : context_(context),
        interaction_(interaction),
        task_(task),
        from_(from),
        margin_(margin),
        clearance_(context, interaction, state, interaction.target->object),
        straight_(context, interaction, from),
        around_(context, interaction, from) {
    clearance_.SetPayload(PayloadPoints(interaction, state));
  }

  // Returns the best plan. `any` receives a plan without a path if it has none yet.
  std::optional<CarryPlan> Plan(std::optional<CarryPlan>* any) {
    for (const double turn : kCarryTurns) {
      if (turn != 0.0 && !task_.may_turn) break;
      std::vector<Arrival> arrivals = ArrivalsAt(context_, interaction_, task_, turn, from_);
      if (!arrivals.empty() && !*any) *any = arrivals.front().plan;
      std::erase_if(arrivals, [&](const Arrival& arrival) {
        return !clearance_.IsCollisionFree(arrival.there);
      });
      StayClear(arrivals);
      if (const auto plan = AddSimplePaths(arrivals)) return plan;
      if (const auto plan = LevelPlanTo(arrivals, turn)) return plan;
    }
    if (around_.best() && (!straight_.best() || around_.IsBetterThan(straight_))) {
      return around_.best();
    }
    return straight_.best() ? straight_.best() : SearchBlocked();
  }

 private:
  void StayClear(const std::vector<Arrival>& arrivals) {
    if (margin_ == 0.0) return;
    std::vector<robot::JointVector> ends{from_};
    for (const Arrival& arrival : arrivals) ends.push_back(arrival.plan.arrival);
    clearance_.SetClearance(margin_, ends);
  }

  // Adds the straight paths, and those through simple waypoints, to `arrivals`. Returns the first
  // that is straight and level.
  std::optional<CarryPlan> AddSimplePaths(const std::vector<Arrival>& arrivals) {
    for (const Arrival& arrival : arrivals) {
      const auto path = PlanSimplePath(context_, clearance_, from_, arrival.plan.arrival);
      if (path && path->empty() && straight_.Add(arrival.plan)) return arrival.plan;
      if (!path && blocked_.size() < kMostSearches &&
          clearance_.IsCollisionFree(arrival.plan.arrival)) {
        blocked_.push_back(arrival.plan);
      }
      if (!path || path->empty()) continue;
      CarryPlan plan = arrival.plan;
      plan.waypoints = *path;
      around_.Add(plan);
    }
    return std::nullopt;
  }

  // Returns a level plan to one of `arrivals`, if the tilt matters and no simple path is level.
  std::optional<CarryPlan> LevelPlanTo(const std::vector<Arrival>& arrivals, double turn) const {
    if (!straight_.matters() || around_.IsLevel() || arrivals.empty()) return std::nullopt;
    LevelGoal goal{PoseBefore(task_, turn), {}, [&](const robot::JointVector& end) {
                     CartesianFollower follower(context_, interaction_, end);
                     return follower.MoveTo(PoseAt(task_, turn)) &&
                            clearance_.IsCollisionFree(follower.configuration());
                   }};
    for (const Arrival& arrival : arrivals) goal.configurations.push_back(arrival.plan.arrival);
    auto path = PlanLevelPath(context_, interaction_, clearance_, from_, goal);
    if (!path) return std::nullopt;
    CarryPlan plan{turn, path->back(), {}};
    path->pop_back();
    plan.waypoints = std::move(*path);
    return plan;
  }

  std::optional<CarryPlan> SearchBlocked() {
    for (CarryPlan& plan : blocked_) {
      if (margin_ > 0.0) clearance_.SetClearance(margin_, {from_, plan.arrival});
      const auto path = PlanRrtConnect(context_.robot->arm, clearance_, from_, plan.arrival);
      if (!path) continue;
      plan.waypoints = *path;
      return plan;
    }
    return std::nullopt;
  }

  const PlanningArm& context_;
  const Interaction& interaction_;
  const CarryTask& task_;
  const robot::JointVector& from_;
  double margin_;
  CollisionChecker clearance_;
  LevelPlan straight_, around_;     // `around_`: through waypoints
  std::vector<CarryPlan> blocked_;  // not reachable by simple waypoints
};

}  // namespace

std::optional<CarryPlan> PlanCarry(const PlanningArm& context, const Interaction& interaction,
                                   const tasks::WorldState& state, const CarryTask& task,
                                   const robot::JointVector& from) {
  std::optional<CarryPlan> any;
  for (const double margin : {kCarryClearance, 0.0}) {
    CarrySearch search(context, interaction, state, task, from, margin);
    if (auto plan = search.Plan(&any)) return plan;
  }
  return any;
}

}  // namespace simwright::manipulation
