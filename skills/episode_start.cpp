#include "skills/episode_start.h"

#include <algorithm>
#include <cmath>

#include "geometry/distance.h"
#include "manipulation/collision_checker.h"
#include "manipulation/goal_placement.h"
#include "manipulation/reach_plan.h"
#include "manipulation/rrt_connect.h"
#include "manipulation/tool_path.h"
#include "manipulation/top_receptacle.h"
#include "skills/downstream_reachability.h"

namespace simwright::skills {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kTries = 60;
constexpr int kMostSearches = 10;  // by RRT-Connect, which is slow where there is no path
constexpr int kPlacedStep = 5;     // tries left out where single objects have ranges: all are alike
constexpr double kFarthestStart = 0.4, kNearest = 0.2;  // m
constexpr double kClearance = 0.02;     // m off opened parts, which the arm would push shut
constexpr double kPerturbation = 0.03;  // rad, perturbation of an arm after another skill
constexpr double kSpacing = 0.005;      // m between AABBs of objects
constexpr double kAtPartShare = 0.5;    // share of partly moved joints with the gripper at the part
constexpr double kNearWall = 0.3;       // of the opening
constexpr double kShortestRetreat = 0.08;  // m, the shortest retreat from a released object
// The outward component of the gripper's axis: a gripper that leans less into a receptacle retreats
// level.
constexpr double kSmallestLean = 0.3;
constexpr double kSteepest = 0.7;   // outward component, or the gripper would hit the ceiling
constexpr double kFromRobot = 0.2;  // m from the robot's axis to an object's AABB

double SampleFactor(const FactorRange& range, core::Rng& rng) {
  return std::exp(core::Uniform(rng, std::log(range.low), std::log(range.high)));
}

Isometry3d Moved(const Isometry3d& pose, const Vector3d& pivot, const Vector3d& shift, double yaw) {
  return Eigen::Translation3d(pivot + shift) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
         Eigen::Translation3d(-pivot) * pose;
}

// Returns the distance (m) by which a try moves the objects away from the robot: an open drawer may
// leave the arm no room where the closed one does. Every other try moves them nearer: a lid moves
// away from the robot as it opens. The first third of the tries keeps the described distance.
double DistanceOffset(int attempt) {
  const double share = std::max(0.0, (attempt - kTries / 3) / (kTries * 2.0 / 3.0));
  return share * (attempt % 2 == 0 ? kFarthestStart : -kNearest);
}

// Returns the range of an object's placement to each side.
PlacementRange RangeOf(const SkillVariant& variant, const SkillOptions& options, int object) {
  const auto t = static_cast<size_t>(object);
  if (!options.placement_ranges.empty()) {
    const auto found = options.placement_ranges.find(variant.model.objects[t].name);
    return found == options.placement_ranges.end() ? PlacementRange() : found->second;
  }
  return {options.position_range, variant.fixed[t]  ? options.furniture_yaw
                                  : options.any_yaw ? M_PI
                                                    : 0.0};
}

// Moves and turns every object; an object in or on another moves with it and turns in place.
// `farther`: m away from the robot, for all of them.
void Scatter(const SkillVariant& variant, const SkillOptions& options, double farther,
             core::Rng& rng, tasks::WorldState* state) {
  const Vector3d robot = variant.subtask.start.world_from_robot.translation();
  for (int pass = 0; pass < 2; ++pass) {  // carriers first
    for (const int object : variant.placed) {
      const auto t = static_cast<size_t>(object);
      const int carrier = variant.carried_by[t];
      if ((carrier >= 0) != (pass == 1)) continue;
      Isometry3d& root = state->roots[t];
      const PlacementRange range = RangeOf(variant, options, object);
      const double yaw = core::Uniform(rng, -range.yaw, range.yaw);
      Vector3d shift = Vector3d::Zero();
      if (carrier < 0) {
        const double far = range.position;
        shift = {core::Uniform(rng, -far, far), core::Uniform(rng, -far, far), 0.0};
        Vector3d away = root.translation() - robot;
        away.z() = 0.0;
        shift += farther * away.normalized();
      } else {
        const auto c = static_cast<size_t>(carrier);
        root = state->roots[c] * variant.start.roots[c].inverse() * root;
      }
      root = Moved(root, tasks::LinkPosition(variant.model, *state, object, 0), shift, yaw);
    }
  }
}

// Returns the convex parts of an object in the world frame.
std::vector<geometry::ConvexShape> ShapesOf(const SkillVariant& variant,
                                            const tasks::WorldState& state, int object) {
  const auto t = static_cast<size_t>(object);
  const std::vector<Isometry3d> poses =
      tasks::LinkPosesOf(variant.model.objects[t], state.joints[t]);
  std::vector<geometry::ConvexShape> shapes;
  const std::vector<sim::RigidBody>& links = variant.bodies[t]->body().links;
  for (size_t l = 0; l < links.size(); ++l) {
    for (const core::TriangleMesh& part : links[l].parts) {
      geometry::ConvexShape& shape = shapes.emplace_back();
      for (const Vector3d& vertex : part.vertices) {
        shape.vertices.push_back(state.roots[t] * poses[l] * vertex);
      }
    }
  }
  return shapes;
}

// Returns true if no convex parts of two objects touch.
bool PartsAreApart(const SkillVariant& variant, const tasks::WorldState& state, int a, int b) {
  const std::vector<geometry::ConvexShape> others = ShapesOf(variant, state, b);
  for (const geometry::ConvexShape& one : ShapesOf(variant, state, a)) {
    for (const geometry::ConvexShape& other : others) {
      if (!geometry::AreApart(one, other, 0.0)) return false;
    }
  }
  return true;
}

// Returns true if the AABBs of two objects are closer than kSpacing; or, for objects whose AABBs
// are so as described and whose placement has a range of its own, if their parts touch.
bool ObjectsOverlap(const SkillVariant& variant, const SkillOptions& options,
                    const tasks::WorldState& state, int a, int b) {
  const auto are_near = [&](const tasks::WorldState& in) {
    return tasks::WorldAabb(variant.model, in, a)
               .exteriorDistance(tasks::WorldAabb(variant.model, in, b)) < kSpacing;
  };
  if (!are_near(state)) return false;
  if (options.placement_ranges.empty() || !are_near(variant.start)) return true;
  return !PartsAreApart(variant, state, a, b) && PartsAreApart(variant, variant.start, a, b);
}

bool Overlap(const SkillVariant& variant, const SkillOptions& options,
             const tasks::WorldState& state) {
  const Vector3d robot = variant.subtask.start.world_from_robot.translation();
  for (const int object : variant.placed) {
    const Eigen::AlignedBox3d box = tasks::WorldAabb(variant.model, state, object);
    if (Eigen::AlignedBox2d(box.min().head<2>(), box.max().head<2>())
            .exteriorDistance(Eigen::Vector2d(robot.head<2>())) < kFromRobot) {
      return true;
    }
  }
  for (size_t i = 0; i < variant.placed.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const int a = variant.placed[i], b = variant.placed[j];
      if (variant.carried_by[static_cast<size_t>(a)] == b) continue;
      if (variant.carried_by[static_cast<size_t>(b)] == a) continue;
      if (ObjectsOverlap(variant, options, state, a, b)) return true;
    }
  }
  return false;
}

// Perturbs each rotary joint by up to `range` rad, within its limits.
void Perturb(const Skill& skill, double range, core::Rng& rng, robot::JointVector* arm) {
  for (Eigen::Index j = 0; j < arm->size(); ++j) {
    const robot::ArmJoint& joint = skill.robot->arm.joints[static_cast<size_t>(j)];
    if (joint.prismatic) continue;
    (*arm)[j] = std::clamp((*arm)[j] + core::Uniform(rng, -range, range), joint.lower, joint.upper);
  }
}

void SampleBodies(const SkillVariant& variant, const SkillOptions& options, core::Rng& rng,
                  StartState* start) {
  start->mass.clear();
  start->friction.clear();
  start->joint.clear();
  for (size_t i = 0; i < variant.model.objects.size(); ++i) {
    start->mass.push_back(SampleFactor(options.mass, rng));
    start->friction.push_back(SampleFactor(options.friction, rng));
    start->joint.push_back(SampleFactor(options.joint, rng));
  }
  start->delay = static_cast<int>(core::UniformIndex(rng, options.longest_delay + 1));
  start->finger_friction.reset();
  if (options.finger_friction) start->finger_friction = SampleFactor(*options.finger_friction, rng);
}

// Computes StartState::withdraw: back along the gripper's own axis, until it is out of its
// receptacle.
Vector3d RetreatDisplacement(const Skill& skill, const SkillVariant& variant,
                             const StartState& start) {
  const Isometry3d tool = variant.subtask.start.world_from_robot *
                          robot::ForwardKinematics(skill.robot->arm, start.arm);
  Vector3d back = -tool.linear().col(2);
  double length = kShortestRetreat;
  if (const auto room =
          manipulation::FindSideReceptacleAround(variant.model, start.state, tool.translation())) {
    const Vector3d out = -manipulation::InwardDirection(*room, variant.model, start.state);
    const Vector3d aside = back - back.dot(out) * out;
    if (back.dot(out) < kSmallestLean) {
      back = out;
    } else if (back.dot(out) < kSteepest) {
      back = kSteepest * out + std::sqrt(1.0 - kSteepest * kSteepest) * aside.normalized();
    }
    const double depth =
        manipulation::DepthIn(*room, variant.model, start.state, tool.translation());
    length = std::max(length, (depth + manipulation::kEntryDistance) / back.dot(out));
  } else if (const auto rim =
                 manipulation::RimHeightAround(variant.model, start.state, tool.translation())) {
    if (back.z() < kSmallestLean) back = Vector3d::UnitZ();
    length =
        std::max(length, (*rim + manipulation::kRimClearance - tool.translation().z()) / back.z());
  }
  return length * back;
}

// Returns true if the skill takes an object out of a side-opening receptacle.
bool TakesFromReceptacle(const SkillVariant& variant, const tasks::WorldState& state) {
  if (!variant.room || variant.target->joint >= 0) return false;
  return manipulation::IsIn(*variant.room, variant.model, state,
                            tasks::LinkPosition(variant.model, state, variant.target->object, 0));
}

// Returns the waypoints of `plan`. Behind an open door, and past one into a receptacle, they
// include the pre-grasp, so that the arm keeps to the path that was checked.
manipulation::JointPath WaypointsTo(const Skill& skill, const SkillVariant& variant,
                                    const tasks::WorldState& state,
                                    const manipulation::ReachPlan& plan) {
  manipulation::JointPath path = plan.waypoints;
  if (variant.target->pushes || TakesFromReceptacle(variant, state)) {
    const robot::JointVector before =
        manipulation::PreGraspConfiguration(skill, variant, state, plan.grasp_configuration);
    if (path.empty() || path.back() != before) path.push_back(before);
  }
  return path;
}

// Searches a joint path from `from` (J) to the pre-grasp of `plan` by RRT-Connect, first with a
// clearance to objects, then without.
void SearchPath(const Skill& skill, const SkillVariant& variant, const tasks::WorldState& state,
                const robot::JointVector& from, manipulation::ReachPlan* plan) {
  const bool takes = variant.target->joint < 0;
  const robot::JointVector before =
      manipulation::PreGraspConfiguration(skill, variant, state, plan->grasp_configuration);
  for (const double margin : {kClearance, 0.0}) {
    manipulation::CollisionChecker clearance(skill, variant, state,
                                             takes ? variant.target->object : -1);
    if (margin > 0.0) clearance.SetClearance(margin, {from, before});
    const auto path = manipulation::PlanRrtConnect(skill.robot->arm, clearance, from, before);
    if (!path) continue;
    plan->waypoints = *path;
    plan->waypoints.push_back(before);
    return;
  }
}

void ApplyPlan(const Skill& skill, const SkillVariant& variant, const manipulation::ReachPlan& plan,
               StartState* start) {
  start->pitch = plan.pitch;
  start->grasp = plan.grasp;
  start->grasp_configuration = plan.grasp_configuration;
  start->waypoints = WaypointsTo(skill, variant, start->state, plan);
}

// The lean (rad) from which on a gripper that holds an object took it leaning.
constexpr double kLeaning = 0.3;

// Plans from `from` (J), else from home after folding the arm; first with a clearance to objects,
// then without.
std::optional<manipulation::ReachPlan> PlanFromAnywhere(const Skill& skill,
                                                        const SkillVariant& variant,
                                                        const tasks::WorldState& state,
                                                        const robot::JointVector& from,
                                                        core::Rng& rng) {
  const bool takes = variant.target->joint < 0;
  std::optional<manipulation::ReachPlan> any, folded;
  for (const double margin : {kClearance, 0.0}) {
    const manipulation::PathOptions wanted{.round = true, .part = true, .margin = margin};
    auto plan = manipulation::PlanReach(skill, variant, state, from, rng, wanted);
    if (plan && plan->IsReachable()) return plan;
    if (!any) any = plan;
    plan = manipulation::PlanReach(skill, variant, state, skill.robot->home(), rng, wanted);
    if (!plan || !plan->IsReachable()) continue;
    manipulation::CollisionChecker clearance(skill, variant, state,
                                             takes ? variant.target->object : -1);
    const robot::JointVector before =
        manipulation::PreGraspConfiguration(skill, variant, state, plan->grasp_configuration);
    if (margin > 0.0) clearance.SetClearance(margin, {from, before});
    const auto path = manipulation::PlanSimplePath(skill, clearance, from, before);
    plan->clear = false;
    plan->waypoints = path.value_or(manipulation::JointPath());
    if (path) return plan;
    folded = plan;
  }
  if (!folded) return any;
  SearchPath(skill, variant, state, from, &*folded);
  return folded;
}

// Plans the motion of an empty gripper after another skill: the retreat, then the approach.
void PlanRetreatAndReach(const Skill& skill, const SkillVariant& variant, core::Rng& rng,
                         StartState* start) {
  start->retreat = RetreatDisplacement(skill, variant, *start);
  Isometry3d away = variant.subtask.start.world_from_robot *
                    robot::ForwardKinematics(skill.robot->arm, start->arm);
  away.translation() += start->retreat;
  manipulation::CartesianFollower follower(skill, variant, start->arm);
  follower.MoveTo(away);
  const auto plan = PlanFromAnywhere(skill, variant, start->state, follower.configuration(), rng);
  if (plan) ApplyPlan(skill, variant, *plan, start);
}

// Samples poses for all objects and plans the manipulation there. Accepts poses with an unreachable
// later skill only if there are no others; after those a plan that is not clear, if possible one
// whose pre-grasp is reached.
void EpisodeStartPlaceObjects(const Skill& skill, core::Rng& rng, StartState* start) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start->variant)];
  const robot::JointVector home = skill.robot->home();
  std::optional<StartState> second_best, reaching, pathless;
  int searches = 0;
  const bool placed = !skill.options.placement_ranges.empty();
  for (int attempt = 0; attempt < kTries; attempt += placed ? kPlacedStep : 1) {
    start->state = variant.start;
    Scatter(variant, skill.options, placed ? 0.0 : DistanceOffset(attempt), rng, &start->state);
    if (Overlap(variant, skill.options, start->state)) continue;
    start->state.goal = manipulation::GoalIn(variant, start->state);
    if (!manipulation::IsArmCollisionFree(skill, variant, start->state, home)) continue;
    if (!variant.target) return;
    const bool round = attempt >= kTries / 3;
    auto plan = manipulation::PlanReach(skill, variant, start->state, home, rng, {.round = round});
    if (plan && plan->IsReachable()) {
      ApplyPlan(skill, variant, *plan, start);
      if (IsDownstreamReachable(skill, start->variant, start->state, rng)) return;
      if (!second_best) second_best = *start;
    } else if (plan && round && !reaching && searches++ < kMostSearches) {
      SearchPath(skill, variant, start->state, home, &*plan);
      ApplyPlan(skill, variant, *plan, start);
      if (plan->IsReachable()) {
        reaching = *start;
      } else if (!pathless) {
        pathless = *start;
      }
    }
    start->state = variant.start;
  }
  for (const auto& choice : {second_best, reaching, pathless}) {
    if (!choice) continue;
    *start = *choice;
    return;
  }
}

// Moves the skill's joint to a random position in its range. Returns false, without moving it, if
// the arm cannot manipulate it there.
bool MoveJointPartly(const Skill& skill, core::Rng& rng, StartState* start) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start->variant)];
  const auto object = static_cast<size_t>(variant.target->object);
  const auto joint = static_cast<size_t>(variant.target->joint);
  const tasks::ObjectJoint& moved = variant.model.objects[object].joints[joint];
  double& position = start->state.joints[object][joint];
  const double before = position;
  position = core::Uniform(rng, moved.lower, moved.upper);
  const robot::JointVector home = skill.robot->home();
  if (manipulation::IsArmCollisionFree(skill, variant, start->state, home)) {
    if (const auto plan = manipulation::PlanReach(skill, variant, start->state, home, rng)) {
      ApplyPlan(skill, variant, *plan, start);
      return true;
    }
  }
  position = before;
  return false;
}

// Places arm and fingers: at home, or at the target if `grasp_configuration` is set or an object is
// grasped.
void PlaceArm(const Skill& skill, bool grasp_configuration, core::Rng& rng, StartState* start) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start->variant)];
  const robot::Gripper& gripper = skill.robot->gripper;
  start->arm = skill.robot->home();
  Perturb(skill, skill.options.configuration_range, rng, &start->arm);
  if (!manipulation::IsArmCollisionFree(skill, variant, start->state, start->arm))
    start->arm = skill.robot->home();
  start->leader = gripper.open;
  grasp_configuration =
      grasp_configuration &&
      manipulation::IsArmCollisionFree(skill, variant, start->state, start->grasp_configuration);
  if (grasp_configuration || start->held >= 0) {
    start->arm = start->grasp_configuration;
    start->waypoints.clear();
  }
  // A wall is thin: fingers that begin near it close sooner.
  if (start->held >= 0 && start->grasp >= 0) {
    start->leader = gripper.LeaderAt(OpeningFor(skill, *start));
  } else if (start->held >= 0 && variant.target->rim > 0.0) {
    start->leader = gripper.closed + kNearWall * (gripper.open - gripper.closed);
  }
  if (grasp_configuration && start->held < 0) {
    start->closed_to = core::Uniform(rng, std::min(gripper.closed, gripper.open),
                                     std::max(gripper.closed, gripper.open));
  }
}

}  // namespace

double OpeningFor(const Skill& skill, const StartState& start) {
  const double widest = skill.robot->gripper.MaxOpening();
  if (start.grasp < 0) return widest;
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start.variant)];
  return std::min(widest, variant.target->grasps[static_cast<size_t>(start.grasp)].opening);
}

StartState SampleStart(const Skill& skill, core::Rng& rng) {
  const SkillOptions& options = skill.options;
  StartState start;
  start.variant =
      static_cast<int>(core::UniformIndex(rng, static_cast<std::int64_t>(skill.variants.size())));
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start.variant)];
  start.grasp_configuration = skill.robot->home();
  EpisodeStartPlaceObjects(skill, rng, &start);
  const double sample = core::Uniform(rng);
  bool grasp_configuration = sample < options.at_target_share;
  const bool partly_open =
      !grasp_configuration && sample < options.at_target_share + options.partly_open_share;
  if (partly_open && variant.target && variant.target->joint >= 0 &&
      MoveJointPartly(skill, rng, &start)) {
    grasp_configuration = core::Uniform(rng) < kAtPartShare;
  }
  const bool grasps = variant.target && variant.target->joint < 0 && variant.asks_for_grasp;
  if (grasps && (partly_open || variant.starts_held)) start.held = variant.target->object;
  PlaceArm(skill, grasp_configuration, rng, &start);
  SampleBodies(variant, options, rng, &start);
  return start;
}

int HeldObject(const SkillVariant& variant, const tasks::WorldState& state) {
  if (!state.grasped || variant.fixed[static_cast<size_t>(state.touched)]) return -1;
  return state.touched;
}

StartState PlannedFrom(const Skill& skill, const StartState& from, core::Rng& rng,
                       Resampling parts) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(from.variant)];
  StartState start = from;
  start.state.goal = manipulation::GoalIn(variant, start.state);
  const bool everything = parts == Resampling::kEverything;
  if (everything && start.held < 0) Perturb(skill, kPerturbation, rng, &start.arm);
  start.grasp_configuration = start.arm;
  start.pitch = 0.0;
  start.grasp = -1;
  start.retreat.setZero();
  start.waypoints.clear();
  if (start.held >= 0) {
    const double lean =
        manipulation::PitchOf(variant.subtask.start.world_from_robot *
                              robot::ForwardKinematics(skill.robot->arm, start.arm));
    // A gripper keeps its lean, even if the object has rotated in the grasp: upright, it may not
    // fit into a receptacle, and an object that it took leaning would be set down tilted.
    if (variant.room || std::abs(lean) > kLeaning) start.pitch = lean;
  }
  if (variant.target && start.held < 0) PlanRetreatAndReach(skill, variant, rng, &start);
  if (everything) SampleBodies(variant, skill.options, rng, &start);
  return start;
}

}  // namespace simwright::skills
