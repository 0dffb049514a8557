#include "rl/focus_frame.h"

#include <algorithm>
#include <cmath>

#include "rl/focus_geometry.h"
#include "rl/joint_work.h"
#include "rl/observation.h"
#include "rl/open_room.h"
#include "rl/reach_plan.h"

namespace simwright::rl {
namespace {

using Eigen::Vector3d;

constexpr int kSurelyHeld = 3;     // updates
constexpr double kLost = 0.06;     // m between the tool and the grasp point: no longer in the hand
constexpr double kInPlace = 0.03;  // m from its axis: what is nearer turns in place
constexpr double kAway = 0.02;     // m from where it gets away to: the hand is away
constexpr double kNearer = 0.003;  // m, of a hand that gets on
constexpr double kLetGo = 0.03;    // m between fingers that have let go of what they were about
constexpr double kAtRest = 0.005;  // m: the hand is where it shall be
// m that what it holds is off its destination all the same: too far to let go of it.
constexpr double kSlid = 0.025;
constexpr int kResting = 4;      // updates
constexpr int kOpening = 10;     // updates that a hand waits for that
constexpr int kStuck = 10;       // updates in which it does not: fingers open in 8 of them
constexpr int kLongestWay = 30;  // updates, 1.5 s at 20 Hz: what is in the way stays there

// FocusFrame::free_way, with the frame at `world_from_focus`.
Vector3d FreeWay(const SkillVariant& variant, const tasks::SceneState& state,
                 const Eigen::Isometry3d& world_from_focus) {
  const Focus& focus = *variant.focus;
  if (focus.joint < 0) return Vector3d::Zero();
  const auto thing = static_cast<size_t>(focus.thing), j = static_cast<size_t>(focus.joint);
  const tasks::ThingJoint& joint = variant.model.things[thing].joints[j];
  const FocusGeometry geometry = GeometryOf(variant.model, state, focus, world_from_focus);
  const bool turns = joint.type != tasks::RewardJointType::kPrismatic;
  if (turns && geometry.hinge.norm() < kInPlace) return Vector3d::Zero();
  const double described = variant.start.joints[thing][j];
  return WorkEnd(joint, described) > described ? geometry.way : Vector3d(-geometry.way);
}

}  // namespace

FocusFrame::FocusFrame(const SkillVariant& variant, const tasks::SceneState& state,
                       const Vector3d& across, double pitch, const Vector3d& withdraw)
    : variant_(variant), across_(across) {
  if (!variant_.focus) return;
  (Pushes(variant_) ? lean_ : pitch_) = pitch;
  world_from_focus_ = ToolAtFocus(variant_, state, across_, pitch_);
  across_ = world_from_focus_.linear().col(1);
  const Eigen::Isometry3d& root = state.roots[static_cast<size_t>(variant_.focus->thing)];
  grip_ = root.inverse() * world_from_focus_.translation();
  at_destination_ = variant_.starts_held && variant_.destination;
  below_ = tasks::LinkPoint(variant_.model, state, variant_.focus->thing, 0).z() -
           tasks::WorldBox(variant_.model, state, variant_.focus->thing).min().z();
  free_way_ = FreeWay(variant_, state, world_from_focus_);
  axes_ = world_from_focus_.linear();
  withdrawing_ = !withdraw.isZero();
  refuge_ = Eigen::Translation3d(withdraw) * state.gripper;
  before_ = state.gripper;
  Update(state);
  withdrawn_ = 0;
}

void FocusFrame::Switch(const tasks::SceneState& state) {
  const bool held = state.grasped && state.touched == variant_.focus->thing;
  held_ = held ? held_ + 1 : 0;
  if (held_ >= kSurelyHeld) at_destination_ = true;
  const Vector3d grasp = state.roots[static_cast<size_t>(variant_.focus->thing)] * grip_;
  const bool lost = (grasp - state.gripper.translation()).norm() > kLost;
  if (lost && !variant_.starts_held) at_destination_ = false;
}

bool FocusFrame::Withdraws(const tasks::SceneState& state) {
  if (!withdrawing_) return false;
  if (opens_ < kOpening && state.opening < kLetGo) {
    ++opens_;
    return true;
  }
  opens_ = kOpening;
  const double missing = (refuge_.translation() - state.gripper.translation()).norm();
  if (missing < nearest_ - kNearer) {
    nearest_ = missing;
    stuck_ = 0;
  }
  if (missing < kAway || ++stuck_ > kStuck || withdrawn_++ >= kLongestWay) {
    withdrawing_ = false;
    world_from_focus_.linear() = axes_;
  }
  return withdrawing_;
}

void FocusFrame::Turn(double angle, const tasks::SceneState& state) {
  const Eigen::AngleAxisd turn(angle, Vector3d::UnitZ());
  world_from_focus_.linear() = turn * world_from_focus_.linear();
  across_ = turn * across_;
  axes_ = turn * axes_;
  FindWayIn(state);
}

// Into a room, and out of it, the hand goes through the opening.
void FocusFrame::FindWayIn(const tasks::SceneState& state) {
  back_ = -Vector3d::UnitZ();
  room_depth_ = 0.0;
  if (at_destination_ && variant_.destination->in_open_room) {
    const Destination& room = *variant_.destination;
    const double rim = tasks::WorldBox(variant_.model, state, room.thing, room.link).max().z();
    const Vector3d thing = tasks::LinkPoint(variant_.model, state, variant_.focus->thing, 0);
    const double bottom = thing.z() + WayToDestination(variant_, state).z() - below_;
    back_ = world_from_focus_.linear().transpose() * Vector3d::UnitZ();
    room_depth_ = std::max(0.0, rim + kOverRim - bottom);
    return;
  }
  if (!variant_.room) return;
  const SideRoom& room = *variant_.room;
  const Vector3d point = world_from_focus_.translation();
  const Vector3d thing = tasks::LinkPoint(variant_.model, state, variant_.focus->thing, 0);
  const bool inside = IsIn(room, variant_.model, state, point);
  if (!inside && !IsIn(room, variant_.model, state, thing)) return;
  const Vector3d way = WayOutOfRoom(variant_, state, point);
  back_ = world_from_focus_.linear().transpose() * way.normalized();
  room_depth_ = way.norm();
}

void FocusFrame::Update(const tasks::SceneState& state) {
  if (!variant_.focus) return;
  if (Withdraws(state)) {
    world_from_focus_ = opens_ < kOpening ? before_ : refuge_;
    return;
  }
  Follow(state);
  FindWayIn(state);
}

// What has slid in the hand is not at its destination when the hand is where it was taken: the hand
// goes on from where it holds it now.
void FocusFrame::GripAnew(const tasks::SceneState& state) {
  const Vector3d tool = state.gripper.translation();
  const bool rests = (tool - world_from_focus_.translation()).norm() < kAtRest;
  resting_ = state.grasped && rests ? resting_ + 1 : 0;
  if (resting_ < kResting || WayToDestination(variant_, state).norm() < kSlid) return;
  grip_ = state.roots[static_cast<size_t>(variant_.focus->thing)].inverse() * tool;
  resting_ = 0;
}

void FocusFrame::Follow(const tasks::SceneState& state) {
  const Focus& focus = *variant_.focus;
  if (focus.joint >= 0 || Pushes(variant_)) {
    world_from_focus_ = ToolAtFocus(variant_, state, across_, pitch_);
    across_ = world_from_focus_.linear().col(1);
    return;
  }
  if (variant_.destination && variant_.asks_for_grasp) Switch(state);
  // In a room the hand stays where it has let go: what it is about would roll on, and lead it away.
  was_held_ = was_held_ || state.grasped;
  if (at_destination_ && variant_.room && variant_.starts_held && was_held_ && !state.grasped) {
    return;
  }
  if (at_destination_) GripAnew(state);
  world_from_focus_.translation() = state.roots[static_cast<size_t>(focus.thing)] * grip_;
  if (at_destination_) world_from_focus_.translation() += WayToDestination(variant_, state);
}

}  // namespace simwright::rl
