#include "rl/episode_start.h"

#include <algorithm>
#include <cmath>

#include "rl/arm_clearance.h"
#include "rl/goal_placement.h"
#include "rl/later_work.h"
#include "rl/open_room.h"
#include "rl/reach_plan.h"
#include "rl/tool_follower.h"
#include "rl/tree_search.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr int kTries = 60;
constexpr double kFarthest = 0.4, kNearest = 0.2;  // m
constexpr double kKeepsOff = 0.02;  // m off what stands open, which the arm would push shut
constexpr double kShake = 0.03;     // rad, of an arm that begins where another skill ended
constexpr double kApart = 0.005;    // m between boxes of things
constexpr double kOnPart = 0.5;     // share of joints part of their way that the hand begins at
constexpr double kNearWall = 0.3;   // of the opening
constexpr double kBackOff = 0.08;   // m that a hand gets away from what it has let go of, at least
// Of the hand's own axis, out of a room: a hand that leans less into it leaves it level.
constexpr double kLeansIn = 0.3;
constexpr double kSteepest = 0.7;   // of the way out of it, or the hand would meet the ceiling
constexpr double kFromRobot = 0.2;  // m from the robot's axis to a thing's box

double Draw(const FactorRange& range, core::Rng& rng) {
  return std::exp(core::Uniform(rng, std::log(range.low), std::log(range.high)));
}

Isometry3d Moved(const Isometry3d& pose, const Vector3d& pivot, const Vector3d& shift, double yaw) {
  return Eigen::Translation3d(pivot + shift) * Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) *
         Eigen::Translation3d(-pivot) * pose;
}

// m that things begin farther from the robot than described, in a try of that number: a drawer that
// stands open may leave the arm no room where the closed one does. Every other time they begin
// nearer: a lid goes away from the robot as it opens. The first third of the tries keeps to the
// description.
double Farther(int attempt) {
  const double share = std::max(0.0, (attempt - kTries / 3) / (kTries * 2.0 / 3.0));
  return share * (attempt % 2 == 0 ? kFarthest : -kNearest);
}

// The try from which on a plan that is not clear will do. An arm that cannot get behind an open
// door opens it wider, for ever; where the furniture is farther away, there is a way.
int UnclearFrom(const SkillVariant& variant) {
  return variant.focus->pushes ? 2 * kTries / 3 : kTries / 3;
}

// Moves and turns every thing; what stands in another goes with it and turns where it stands.
// `farther`: m away from the robot, all of them.
void Scatter(const SkillVariant& variant, const SkillOptions& options, double farther,
             core::Rng& rng, tasks::SceneState* state) {
  const Vector3d robot = variant.subtask.start.world_from_robot.translation();
  for (int pass = 0; pass < 2; ++pass) {  // carriers first
    for (const int thing : variant.placed) {
      const auto t = static_cast<size_t>(thing);
      const int carrier = variant.carried_by[t];
      if ((carrier >= 0) != (pass == 1)) continue;
      Isometry3d& root = state->roots[t];
      const bool fixed = variant.fixed[t];
      const double yaw_range = fixed ? options.furniture_yaw : options.any_yaw ? M_PI : 0.0;
      const double yaw = core::Uniform(rng, -yaw_range, yaw_range);
      Vector3d shift = Vector3d::Zero();
      if (carrier < 0) {
        const double range = options.position_range;
        shift = {core::Uniform(rng, -range, range), core::Uniform(rng, -range, range), 0.0};
        Vector3d away = root.translation() - robot;
        away.z() = 0.0;
        shift += farther * away.normalized();
      } else {
        const auto c = static_cast<size_t>(carrier);
        root = state->roots[c] * variant.start.roots[c].inverse() * root;
      }
      root = Moved(root, tasks::LinkPoint(variant.model, *state, thing, 0), shift, yaw);
    }
  }
}

bool Overlap(const SkillVariant& variant, const tasks::SceneState& state) {
  const Vector3d robot = variant.subtask.start.world_from_robot.translation();
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const int thing : variant.placed) {
    boxes.push_back(tasks::WorldBox(variant.model, state, thing));
    if (Eigen::AlignedBox2d(boxes.back().min().head<2>(), boxes.back().max().head<2>())
            .exteriorDistance(Eigen::Vector2d(robot.head<2>())) < kFromRobot) {
      return true;
    }
  }
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      const int a = variant.placed[i], b = variant.placed[j];
      if (variant.carried_by[static_cast<size_t>(a)] == b) continue;
      if (variant.carried_by[static_cast<size_t>(b)] == a) continue;
      if (boxes[i].exteriorDistance(boxes[j]) < kApart) return true;
    }
  }
  return false;
}

// Moves each joint that turns by up to `range` rad, within its limits.
void Shake(const Skill& skill, double range, core::Rng& rng, robot::Posture* arm) {
  for (Eigen::Index j = 0; j < arm->size(); ++j) {
    const robot::ArmJoint& joint = skill.robot->arm.joints[static_cast<size_t>(j)];
    if (joint.prismatic) continue;
    (*arm)[j] = std::clamp((*arm)[j] + core::Uniform(rng, -range, range), joint.lower, joint.upper);
  }
}

void DrawBodies(const SkillVariant& variant, const SkillOptions& options, core::Rng& rng,
                EpisodeStart* start) {
  start->mass.clear();
  start->friction.clear();
  start->joint.clear();
  for (size_t i = 0; i < variant.model.things.size(); ++i) {
    start->mass.push_back(Draw(options.mass, rng));
    start->friction.push_back(Draw(options.friction, rng));
    start->joint.push_back(Draw(options.joint, rng));
  }
  start->delay = static_cast<int>(core::UniformIndex(rng, options.longest_delay + 1));
  start->finger_friction.reset();
  if (options.finger_friction) start->finger_friction = Draw(*options.finger_friction, rng);
}

// EpisodeStart::withdraw: back along the hand's own axis, until it is out of the room that it is
// in.
Vector3d WayOut(const Skill& skill, const SkillVariant& variant, const EpisodeStart& start) {
  const Isometry3d tool = variant.subtask.start.world_from_robot *
                          robot::ForwardKinematics(skill.robot->arm, start.arm);
  Vector3d back = -tool.linear().col(2);
  double length = kBackOff;
  if (const auto room = SideRoomAround(variant.model, start.state, tool.translation())) {
    const Vector3d out = -InwardOf(*room, variant.model, start.state);
    const Vector3d aside = back - back.dot(out) * out;
    if (back.dot(out) < kLeansIn) {
      back = out;
    } else if (back.dot(out) < kSteepest) {
      back = kSteepest * out + std::sqrt(1.0 - kSteepest * kSteepest) * aside.normalized();
    }
    const double depth = DepthIn(*room, variant.model, start.state, tool.translation());
    length = std::max(length, (depth + kBeforeOpening) / back.dot(out));
  } else if (const auto rim = RimAround(variant.model, start.state, tool.translation())) {
    if (back.z() < kLeansIn) back = Vector3d::UnitZ();
    length = std::max(length, (*rim + kOverRim - tool.translation().z()) / back.z());
  }
  return length * back;
}

// Whether what the skill takes stands in a room that opens to a side.
bool TakesFromRoom(const SkillVariant& variant, const tasks::SceneState& state) {
  if (!variant.room || variant.focus->joint >= 0) return false;
  return IsIn(*variant.room, variant.model, state,
              tasks::LinkPoint(variant.model, state, variant.focus->thing, 0));
}

// The way of an arm that does `plan`: behind an open door, and past one into a room, it
// gets only the way that was looked at.
Detour WayToWork(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
                 const ReachPlan& plan) {
  Detour way = plan.via;
  if (variant.focus->pushes || TakesFromRoom(variant, state)) {
    const robot::Posture before = BeforeWork(skill, variant, state, plan.at_work);
    if (way.empty() || way.back() != before) way.push_back(before);
  }
  return way;
}

// Where no simple way is clear from `from` (J) to the work of `plan`: one that is searched for,
// past things at some distance, or else as the arm can.
void SearchWay(const Skill& skill, const SkillVariant& variant, const tasks::SceneState& state,
               const robot::Posture& from, ReachPlan* plan) {
  const bool takes = variant.focus->joint < 0;
  const robot::Posture before = BeforeWork(skill, variant, state, plan->at_work);
  for (const double margin : {kKeepsOff, 0.0}) {
    ArmClearance clearance(skill, variant, state, takes ? variant.focus->thing : -1);
    if (margin > 0.0) clearance.KeepOff(margin, {from, before});
    const auto way = SearchDetour(skill.robot->arm, clearance, from, before);
    if (!way) continue;
    plan->via = *way;
    plan->via.push_back(before);
    return;
  }
}

void Follow(const Skill& skill, const SkillVariant& variant, const ReachPlan& plan,
            EpisodeStart* start) {
  start->pitch = plan.pitch;
  start->at_work = plan.at_work;
  start->via = WayToWork(skill, variant, start->state, plan);
}

// From `from` (J): a plan to whose work the arm gets from there, or else folded as at home first;
// past things at some distance, or else as it can.
std::optional<ReachPlan> PlanFromAnywhere(const Skill& skill, const SkillVariant& variant,
                                          const tasks::SceneState& state,
                                          const robot::Posture& from, core::Rng& rng) {
  const bool takes = variant.focus->joint < 0;
  std::optional<ReachPlan> any, folded;
  for (const double margin : {kKeepsOff, 0.0}) {
    const WayWanted wanted{.round = true, .part = true, .margin = margin};
    auto plan = PlanReach(skill, variant, state, from, rng, wanted);
    if (plan && plan->GetsThere()) return plan;
    if (!any) any = plan;
    plan = PlanReach(skill, variant, state, skill.robot->home(), rng, wanted);
    if (!plan || !plan->GetsThere()) continue;
    ArmClearance clearance(skill, variant, state, takes ? variant.focus->thing : -1);
    const robot::Posture before = BeforeWork(skill, variant, state, plan->at_work);
    if (margin > 0.0) clearance.KeepOff(margin, {from, before});
    const auto way = PlanDetour(skill, clearance, from, before);
    plan->clear = false;
    plan->via = way.value_or(Detour());
    if (way) return plan;
    folded = plan;
  }
  if (!folded) return any;
  SearchWay(skill, variant, state, from, &*folded);
  return folded;
}

// How an empty hand goes from where another skill has left it: away from there, then to its work.
void PlanFromBefore(const Skill& skill, const SkillVariant& variant, core::Rng& rng,
                    EpisodeStart* start) {
  start->withdraw = WayOut(skill, variant, *start);
  Isometry3d away = variant.subtask.start.world_from_robot *
                    robot::ForwardKinematics(skill.robot->arm, start->arm);
  away.translation() += start->withdraw;
  ToolFollower follower(skill, variant, start->arm);
  follower.Goes(away);
  const auto plan = PlanFromAnywhere(skill, variant, start->state, follower.posture(), rng);
  if (plan) Follow(skill, variant, *plan, start);
}

// Finds a place for every thing, and plans the work there. A place where only what comes later in
// the task is out of reach will do where there is no other.
void PlaceThings(const Skill& skill, core::Rng& rng, EpisodeStart* start) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start->variant)];
  const robot::Posture home = skill.robot->home();
  std::optional<EpisodeStart> second_best;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    start->state = variant.start;
    Scatter(variant, skill.options, Farther(attempt), rng, &start->state);
    if (Overlap(variant, start->state)) continue;
    start->state.goal = GoalIn(variant, start->state);
    if (!IsArmClear(skill, variant, start->state, home)) continue;
    if (!variant.focus) return;
    const bool round = attempt >= kTries / 3;
    auto plan = PlanReach(skill, variant, start->state, home, rng, {.round = round});
    if (plan && !plan->GetsThere() && round) {
      SearchWay(skill, variant, start->state, home, &*plan);
    }
    if (plan && (plan->GetsThere() || attempt >= UnclearFrom(variant))) {
      Follow(skill, variant, *plan, start);
      if (IsLaterWorkInReach(skill, start->variant, start->state, rng)) return;
      if (!second_best) second_best = *start;
    }
    start->state = variant.start;
  }
  if (second_best) *start = *second_best;
}

// Moves the joint that the skill works on to anywhere in its range, if the arm can do its work
// there. Whether it can.
bool MovePartWay(const Skill& skill, core::Rng& rng, EpisodeStart* start) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start->variant)];
  const auto thing = static_cast<size_t>(variant.focus->thing);
  const auto joint = static_cast<size_t>(variant.focus->joint);
  const tasks::ThingJoint& moved = variant.model.things[thing].joints[joint];
  double& position = start->state.joints[thing][joint];
  const double before = position;
  position = core::Uniform(rng, moved.lower, moved.upper);
  const robot::Posture home = skill.robot->home();
  if (IsArmClear(skill, variant, start->state, home)) {
    if (const auto plan = PlanReach(skill, variant, start->state, home, rng)) {
      Follow(skill, variant, *plan, start);
      return true;
    }
  }
  position = before;
  return false;
}

// Where arm and fingers begin: at home, or at their work as `at_work` and what is held say.
void PlaceArm(const Skill& skill, bool at_work, core::Rng& rng, EpisodeStart* start) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start->variant)];
  const robot::Gripper& gripper = skill.robot->gripper;
  start->arm = skill.robot->home();
  Shake(skill, skill.options.posture_range, rng, &start->arm);
  if (!IsArmClear(skill, variant, start->state, start->arm)) start->arm = skill.robot->home();
  start->leader = gripper.open;
  at_work = at_work && IsArmClear(skill, variant, start->state, start->at_work);
  if (at_work || start->held >= 0) {
    start->arm = start->at_work;
    start->via.clear();
  }
  // A wall is thin: fingers that begin near it are closed sooner.
  if (start->held >= 0 && variant.focus->rim > 0.0) {
    start->leader = gripper.closed + kNearWall * (gripper.open - gripper.closed);
  }
  if (at_work && start->held < 0) {
    start->closed_to = core::Uniform(rng, std::min(gripper.closed, gripper.open),
                                     std::max(gripper.closed, gripper.open));
  }
}

}  // namespace

EpisodeStart DrawStart(const Skill& skill, core::Rng& rng) {
  const SkillOptions& options = skill.options;
  EpisodeStart start;
  start.variant =
      static_cast<int>(core::UniformIndex(rng, static_cast<std::int64_t>(skill.variants.size())));
  const SkillVariant& variant = skill.variants[static_cast<size_t>(start.variant)];
  start.at_work = skill.robot->home();
  PlaceThings(skill, rng, &start);
  const double lot = core::Uniform(rng);
  bool at_work = lot < options.at_focus_share;
  const bool part_way = !at_work && lot < options.at_focus_share + options.part_way_share;
  if (part_way && variant.focus && variant.focus->joint >= 0 && MovePartWay(skill, rng, &start)) {
    at_work = core::Uniform(rng) < kOnPart;
  }
  const bool grasps = variant.focus && variant.focus->joint < 0 && variant.asks_for_grasp;
  if (grasps && (part_way || variant.starts_held)) start.held = variant.focus->thing;
  PlaceArm(skill, at_work, rng, &start);
  DrawBodies(variant, options, rng, &start);
  return start;
}

int HeldThing(const SkillVariant& variant, const tasks::SceneState& state) {
  if (!state.grasped || variant.fixed[static_cast<size_t>(state.touched)]) return -1;
  return state.touched;
}

EpisodeStart Varied(const Skill& skill, const EpisodeStart& from, core::Rng& rng,
                    VariedParts parts) {
  const SkillVariant& variant = skill.variants[static_cast<size_t>(from.variant)];
  EpisodeStart start = from;
  start.state.goal = GoalIn(variant, start.state);
  const bool everything = parts == VariedParts::kEverything;
  if (everything && start.held < 0) Shake(skill, kShake, rng, &start.arm);
  start.at_work = start.arm;
  start.pitch = 0.0;
  start.withdraw.setZero();
  start.via.clear();
  if (start.held >= 0 && variant.room) {
    // It keeps its lean, whatever the thing has turned by in it: upright, it may not fit.
    start.pitch = PitchOf(variant.subtask.start.world_from_robot *
                          robot::ForwardKinematics(skill.robot->arm, start.arm));
  }
  if (variant.focus && start.held < 0) PlanFromBefore(skill, variant, rng, &start);
  if (everything) DrawBodies(variant, skill.options, rng, &start);
  return start;
}

}  // namespace simwright::rl
