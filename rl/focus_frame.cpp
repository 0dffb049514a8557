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

constexpr int kGraspUpdates = 3;     // consecutive updates in the grasp
constexpr double kLost = 0.06;       // m between tool and grasp point: the object is lost
constexpr double kInPlace = 0.03;    // m from its axis: a nearer part rotates in place
constexpr double kRetreated = 0.02;  // m from the retreat pose: the retreat is complete
constexpr double kProgress = 0.003;  // m, of progress
constexpr double kReleased = 0.03;   // m between fingers that have released the object
constexpr double kAtRest = 0.005;    // m: the gripper is at the frame
// m from the object to its destination, with the gripper at rest: too far to release it.
constexpr double kSlid = 0.025;
constexpr int kRestUpdates = 4;      // updates
constexpr int kOpeningUpdates = 10;  // updates that the gripper waits to open
constexpr int kStuckUpdates = 10;    // updates without progress; fingers open in 8
constexpr int kLongestRetreat = 30;  // updates, 1.5 s at 20 Hz; an obstacle does not go away

// Returns FocusFrame::free_way for the frame at `world_from_focus`.
Vector3d MotionDirection(const SkillVariant& variant, const tasks::SceneState& state,
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
  grasp_point_ = root.inverse() * world_from_focus_.translation();
  at_destination_ = variant_.starts_held && variant_.destination;
  below_ = tasks::LinkPoint(variant_.model, state, variant_.focus->thing, 0).z() -
           tasks::WorldBox(variant_.model, state, variant_.focus->thing).min().z();
  free_way_ = MotionDirection(variant_, state, world_from_focus_);
  axes_ = world_from_focus_.linear();
  withdrawing_ = !withdraw.isZero();
  retreat_ = Eigen::Translation3d(withdraw) * state.gripper;
  before_ = state.gripper;
  Update(state);
  updates_withdrawing_ = 0;
}

void FocusFrame::UpdateAtDestination(const tasks::SceneState& state) {
  const bool held = state.grasped && state.touched == variant_.focus->thing;
  held_ = held ? held_ + 1 : 0;
  if (held_ >= kGraspUpdates) at_destination_ = true;
  const Vector3d grasp = state.roots[static_cast<size_t>(variant_.focus->thing)] * grasp_point_;
  const bool lost = (grasp - state.gripper.translation()).norm() > kLost;
  if (lost && !variant_.starts_held) at_destination_ = false;
}

bool FocusFrame::Withdraws(const tasks::SceneState& state) {
  if (!withdrawing_) return false;
  if (updates_opening_ < kOpeningUpdates && state.opening < kReleased) {
    ++updates_opening_;
    return true;
  }
  updates_opening_ = kOpeningUpdates;
  const double missing = (retreat_.translation() - state.gripper.translation()).norm();
  if (missing < smallest_distance_ - kProgress) {
    smallest_distance_ = missing;
    updates_stuck_ = 0;
  }
  if (missing < kRetreated || ++updates_stuck_ > kStuckUpdates ||
      updates_withdrawing_++ >= kLongestRetreat) {
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
  ComputeRetreat(state);
}

// The gripper enters and leaves a receptacle through its opening.
void FocusFrame::ComputeRetreat(const tasks::SceneState& state) {
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
    world_from_focus_ = updates_opening_ < kOpeningUpdates ? before_ : retreat_;
    return;
  }
  Follow(state);
  ComputeRetreat(state);
}

// If the object has slipped in the grasp, it is off its destination when the gripper is at the
// frame: takes the current tool position as the new grasp point.
void FocusFrame::UpdateGraspPoint(const tasks::SceneState& state) {
  const Vector3d tool = state.gripper.translation();
  const bool rests = (tool - world_from_focus_.translation()).norm() < kAtRest;
  updates_at_rest_ = state.grasped && rests ? updates_at_rest_ + 1 : 0;
  if (updates_at_rest_ < kRestUpdates || WayToDestination(variant_, state).norm() < kSlid) return;
  grasp_point_ = state.roots[static_cast<size_t>(variant_.focus->thing)].inverse() * tool;
  updates_at_rest_ = 0;
}

void FocusFrame::Follow(const tasks::SceneState& state) {
  const Focus& focus = *variant_.focus;
  if (focus.joint >= 0 || Pushes(variant_)) {
    world_from_focus_ = ToolAtFocus(variant_, state, across_, pitch_);
    across_ = world_from_focus_.linear().col(1);
    return;
  }
  if (variant_.destination && variant_.asks_for_grasp) UpdateAtDestination(state);
  // In a side-opening receptacle the gripper stays where it released the object: a rolling object
  // would lead it away.
  was_held_ = was_held_ || state.grasped;
  if (at_destination_ && variant_.room && variant_.starts_held && was_held_ && !state.grasped) {
    return;
  }
  if (at_destination_) UpdateGraspPoint(state);
  world_from_focus_.translation() = state.roots[static_cast<size_t>(focus.thing)] * grasp_point_;
  if (at_destination_) world_from_focus_.translation() += WayToDestination(variant_, state);
}

}  // namespace simwright::rl
