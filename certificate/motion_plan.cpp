#include "certificate/motion_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "certificate/grasp_order.h"
#include "certificate/planner.h"
#include "core/progress.h"
#include "manipulation/rrt_connect.h"

namespace simwright::certificate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using robot::JointVector;
using Waypoints = std::vector<JointVector>;

constexpr double kLineStep = 0.008;     // m between configurations on a straight line
constexpr double kLargestChange = 0.2;  // rad or m of any joint per step of a line
constexpr double kInContact = 0.012;    // m of a lift in which the target may touch its neighbours
constexpr double kTouches = 0.002;      // m: neighbours at the start
constexpr double kInFrontGap = 0.03;    // m between the furniture and an object in front of it
constexpr double kLower = 0.03;         // m of the straight way down to a place
constexpr double kRetreat = 0.08;       // m of the straight way back from a place
constexpr int kGoalSolutions = 4;       // starts of the inverse kinematics per pose at the goal
constexpr std::array kLifts = {0.03, 0.06, 0.016};                        // m
constexpr std::array kGoalYaws = {0.0, 0.5, -0.5, 1.1, -1.1, 1.6, -1.6};  // rad of a placed object

// The displacements (m: across, upwards) of poses in front of the furniture, preferred first.
constexpr std::array<std::pair<double, double>, 5> kInFrontOffsets = {
    {{0.0, 0.0}, {0.0, 0.06}, {0.0, -0.03}, {0.1, 0.0}, {-0.1, 0.0}}};

Isometry3d Shifted(Isometry3d pose, const Vector3d& by) {
  pose.translation() += by;
  return pose;
}

}  // namespace

class MotionSearch::Impl {
 public:
  Impl(const Planner& planner, const PlacedScene& scene, int target, const Goal& goal,
       const Isometry3d& world_from_robot, const MotionOptions& options)
      : planner_(planner),
        target_(scene.bodies[static_cast<size_t>(target)]),
        goal_(goal),
        world_from_robot_(world_from_robot),
        robot_from_world_(world_from_robot.inverse()),
        options_(options),
        obstacles_(scene),
        clearance_(planner.shapes(), obstacles_, world_from_robot, options.margins),
        grasps_(planner.GraspsOf(target_.model)),
        box_(BoundsOf(target_)) {
    obstacles_.Ignore(target, true);
    clearance_.CountHits(scene.bodies.size());
    const int support = SupportOf(scene, target);
    if (support >= 0) front_ = BoundsOf(scene.bodies[static_cast<size_t>(support)]).min().x();
    touching_.assign(scene.bodies.size(), 0);
    PlacedShape shape;
    for (const geometry::ConvexShape& part : target_.model->parts) {
      shape.Place(part, target_.world_from_body);
      obstacles_.Mark(shape, kTouches, &touching_);
    }
    order_ =
        OrderGrasps(grasps_, target_, world_from_robot, options.standoff, &clearance_, &counts_);
    counts_.hits = clearance_.hits();
  }

  std::optional<MotionPlan> Next() {
    while (at_ < order_.size() && counts_.tried < options_.candidates &&
           failed_trees_ < options_.tree_searches) {
      core::CheckCancelled();
      core::Rng rng = core::StreamRng(options_.seed, at_);
      const Grasp& grasp = grasps_[order_[at_++]];
      ++counts_.tried;
      std::optional<MotionPlan> plan = PlanWith(grasp, rng);
      counts_.hits = clearance_.hits();
      if (plan) return plan;
    }
    return std::nullopt;
  }

  const SearchCounts& counts() const { return counts_; }

 private:
  // The way from a grasp to its pre-grasp, back to front.
  struct Access {
    JointVector grasp;
    Waypoints back;
  };

  std::optional<MotionPlan> PlanWith(const Grasp& given, core::Rng& rng) {
    bool reachable = false, arm_free = false;
    for (const bool flipped : {false, true}) {  // both fingers may change places
      Grasp grasp = given;
      if (flipped) grasp.body_from_tool.linear().leftCols<2>() *= -1.0;
      const Isometry3d tool = target_.world_from_body * grasp.body_from_tool;
      const JointVector home = planner_.robot().home();
      for (const JointVector& q :
           planner_.Solutions(robot_from_world_ * tool, home, options_.arm_solutions, rng)) {
        reachable = true;
        Release(grasp.leader);
        if (!clearance_.IsConfigurationFree(q)) continue;
        arm_free = true;
        if (auto plan = PlanFrom(grasp, tool, q, rng)) return plan;
        if (failed_trees_ >= options_.tree_searches) break;
      }
    }
    if (!reachable) {
      ++counts_.unreachable;
    } else if (!arm_free) {
      ++counts_.arm_rejected;
    } else {
      ++counts_.path_rejected;
    }
    return std::nullopt;
  }

  void Release(double leader) {
    clearance_.SetLeader(leader);
    clearance_.Hold(nullptr, Isometry3d::Identity());
  }

  std::optional<MotionPlan> PlanFrom(const Grasp& grasp, const Isometry3d& tool,
                                     const JointVector& q, core::Rng& rng) {
    const Vector3d approach = tool.linear().col(2);
    Waypoints back = {q};
    if (!FollowLine(tool, -options_.standoff * approach, &back)) return std::nullopt;
    MotionPlan plan;
    plan.grasp = grasp;
    const robot::Gripper& gripper = planner_.robot().gripper;
    const double closed = std::max(gripper.closed, grasp.width / gripper.opening_ratio);
    std::vector<PlanSegment> after;
    clearance_.SetLeader(closed);
    clearance_.Hold(target_.model.get(), grasp.body_from_tool.inverse());
    if (!PlanToGoal(grasp, tool, q, rng, &after)) return std::nullopt;
    Release(grasp.leader);
    ExtendOutOfFurniture(Shifted(tool, -options_.standoff * approach), &back);
    const JointVector home = planner_.robot().home();
    const auto reach = JointPathBetween(home, back.back());
    if (!reach) return std::nullopt;
    plan.segments.push_back({Phase::kReach, *reach, grasp.leader});
    plan.segments.push_back({Phase::kApproach, {back.rbegin(), back.rend()}, grasp.leader});
    plan.segments.push_back({Phase::kClose, {q}, gripper.closed});
    plan.segments.insert(plan.segments.end(), after.begin(), after.end());
    return plan;
  }

  // Extends the way back to in front of the furniture, along a straight line, if that is free: from
  // there a joint path home is found soon.
  void ExtendOutOfFurniture(const Isometry3d& pre_grasp, Waypoints* back) const {
    const double out = front_ - pre_grasp.translation().x();
    if (out >= 0.0) return;
    Waypoints extended = *back;
    if (FollowLine(pre_grasp, out * Vector3d::UnitX(), &extended)) *back = extended;
  }

  // Plans what follows the grasp, with the target in the gripper.
  bool PlanToGoal(const Grasp& grasp, const Isometry3d& tool, const JointVector& q, core::Rng& rng,
                  std::vector<PlanSegment>* segments) {
    for (const double lift : kLifts) {
      const double height = goal_.kind == GoalKind::kLift ? goal_.lift + 0.02 : lift;
      Waypoints up = {q};
      clearance_.IgnoreForHeld(&touching_);
      bool lifted = FollowLine(tool, std::min(kInContact, height) * Vector3d::UnitZ(), &up);
      clearance_.IgnoreForHeld(nullptr);
      const Isometry3d low = Shifted(tool, std::min(kInContact, height) * Vector3d::UnitZ());
      lifted =
          lifted && FollowLine(low, std::max(0.0, height - kInContact) * Vector3d::UnitZ(), &up);
      if (lifted) {
        segments->assign({{Phase::kLift, up, planner_.robot().gripper.closed}});
        if (goal_.kind == GoalKind::kLift) return true;
        const Isometry3d raised = Shifted(tool, height * Vector3d::UnitZ());
        const bool done = goal_.kind == GoalKind::kInFront
                              ? PlanInFront(raised, up.back(), rng, segments)
                              : PlanPlace(grasp, up.back(), rng, segments);
        if (done) return true;
      }
      if (goal_.kind == GoalKind::kLift || failed_trees_ >= options_.tree_searches) return false;
    }
    return false;
  }

  bool PlanInFront(const Isometry3d& raised, const JointVector& from, core::Rng& rng,
                   std::vector<PlanSegment>* segments) {
    const double out = goal_.front - kInFrontGap - box_.max().x();
    const double closed = planner_.robot().gripper.closed;
    Waypoints straight = {from};
    if (FollowLine(raised, out * Vector3d::UnitX(), &straight)) {
      segments->push_back({Phase::kCarry, straight, closed});
      return true;
    }
    for (const auto& [across, up] : kInFrontOffsets) {
      const Isometry3d pose = Shifted(raised, {out, across, up});
      const auto path = PathToPose(from, pose, rng);
      if (!path) continue;
      segments->push_back({Phase::kCarry, *path, closed});
      return true;
    }
    return false;
  }

  bool PlanPlace(const Grasp& grasp, const JointVector& from, core::Rng& rng,
                 std::vector<PlanSegment>* segments) {
    for (const Isometry3d& place : goal_.places) {
      for (const double yaw : kGoalYaws) {
        Isometry3d body = place;
        const Vector3d middle = place * target_.model->box.center();
        body.linear() = Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * place.linear();
        body.translation() += middle - body * target_.model->box.center();
        const Isometry3d tool = body * grasp.body_from_tool;
        if (PlanPlaceAt(grasp, tool, from, rng, segments)) return true;
        if (failed_trees_ >= options_.tree_searches) return false;
      }
    }
    return false;
  }

  bool PlanPlaceAt(const Grasp& grasp, const Isometry3d& tool, const JointVector& from,
                   core::Rng& rng, std::vector<PlanSegment>* segments) {
    const double closed = planner_.robot().gripper.closed;
    const Isometry3d above = Shifted(tool, kLower * Vector3d::UnitZ());
    const auto carry = PathToPose(from, above, rng);
    if (!carry) return false;
    Waypoints down = {carry->back()};
    // The target touches its surface at the end.
    clearance_.IgnoreForHeld(&touching_);
    const bool lowered = FollowLine(above, -kLower * Vector3d::UnitZ(), &down);
    clearance_.IgnoreForHeld(nullptr);
    if (!lowered) return false;
    Release(grasp.leader);
    Waypoints away = {down.back()};
    const bool retreats = FollowLine(tool, -kRetreat * tool.linear().col(2), &away);
    clearance_.SetLeader(grasp.width / planner_.robot().gripper.opening_ratio);
    clearance_.Hold(target_.model.get(), grasp.body_from_tool.inverse());
    if (!retreats) return false;
    segments->push_back({Phase::kCarry, *carry, closed});
    segments->push_back({Phase::kLower, down, closed});
    segments->push_back({Phase::kOpen, {down.back()}, grasp.leader});
    segments->push_back({Phase::kRetreat, away, grasp.leader});
    return true;
  }

  // Appends the configurations along a straight line of the tool, from the last one at
  // `world_from_tool`; false if the arm cannot follow or hits something.
  bool FollowLine(const Isometry3d& world_from_tool, const Vector3d& displacement,
                  Waypoints* line) const {
    const int steps = static_cast<int>(std::ceil(displacement.norm() / kLineStep));
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const auto next = planner_.Solve(
          robot_from_world_ * Shifted(world_from_tool, share * displacement), line->back());
      if (!next) return false;
      if ((*next - line->back()).lpNorm<Eigen::Infinity>() > kLargestChange) return false;
      if (!clearance_.IsPathCollisionFree(line->back(), *next)) return false;
      line->push_back(*next);
    }
    return true;
  }

  std::optional<Waypoints> PathToPose(const JointVector& from, const Isometry3d& world_from_tool,
                                      core::Rng& rng) {
    for (const JointVector& to :
         planner_.Solutions(robot_from_world_ * world_from_tool, from, kGoalSolutions, rng)) {
      if (!clearance_.IsConfigurationFree(to)) continue;
      if (auto path = JointPathBetween(from, to)) return path;
      if (failed_trees_ >= options_.tree_searches) return std::nullopt;
    }
    return std::nullopt;
  }

  std::optional<Waypoints> JointPathBetween(const JointVector& from, const JointVector& to) {
    if (clearance_.IsPathCollisionFree(from, to)) return Waypoints{from, to};
    ++counts_.tree_searches;
    const auto between = manipulation::PlanRrtConnect(planner_.robot().arm, clearance_, from, to,
                                                      options_.tree_rounds);
    if (!between) {
      ++failed_trees_;
      return std::nullopt;
    }
    Waypoints path = {from};
    path.insert(path.end(), between->begin(), between->end());
    path.push_back(to);
    return path;
  }

  const Planner& planner_;
  const PlacedBody& target_;
  const Goal& goal_;
  Isometry3d world_from_robot_, robot_from_world_;
  const MotionOptions& options_;
  Obstacles obstacles_;
  RobotClearance clearance_;
  const std::vector<Grasp>& grasps_;
  Eigen::AlignedBox3d box_;
  double front_ = HUGE_VAL;     // m, x of the front of the furniture that supports the target
  std::vector<char> touching_;  // by body: touches the target at the start
  std::vector<size_t> order_;   // of grasps_
  size_t at_ = 0;
  int failed_trees_ = 0;
  SearchCounts counts_;
};

MotionSearch::MotionSearch(const Planner& planner, const PlacedScene& scene, int target,
                           const Goal& goal, const Isometry3d& world_from_robot,
                           const MotionOptions& options)
    : impl_(std::make_unique<Impl>(planner, scene, target, goal, world_from_robot, options)) {}

MotionSearch::~MotionSearch() = default;

std::optional<MotionPlan> MotionSearch::Next() {
  return impl_->Next();
}

const SearchCounts& MotionSearch::counts() const {
  return impl_->counts();
}

std::string PhaseName(Phase phase) {
  constexpr std::array kNames = {"reach", "approach", "close", "lift",
                                 "carry", "lower",    "open",  "retreat"};
  return kNames[static_cast<size_t>(phase)];
}

double MotionPlan::Length() const {
  double length = 0.0;
  for (const PlanSegment& segment : segments) {
    for (size_t i = 1; i < segment.waypoints.size(); ++i) {
      length += (segment.waypoints[i] - segment.waypoints[i - 1]).lpNorm<Eigen::Infinity>();
    }
  }
  return length;
}

bool MotionOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (candidates < 1 || candidates > 100000) {
    return fail("the number of candidates must be 1 to 100000");
  }
  if (arm_solutions < 1 || arm_solutions > 1000) return fail("arm_solutions must be 1 to 1000");
  if (!(standoff > 0.0 && standoff < 1.0)) return fail("standoff must be 0 to 1 m");
  if (tree_rounds < 1 || tree_searches < 1) return fail("a search needs at least one round");
  if (!(margins.arm >= 0.0) || !(margins.gripper >= 0.0) || !(margins.held >= 0.0)) {
    return fail("margins must not be negative");
  }
  return true;
}

}  // namespace simwright::certificate
