#include "manipulation/target_frame.h"

#include <algorithm>
#include <cmath>

#include "manipulation/goal_displacement.h"
#include "manipulation/joint_target.h"
#include "manipulation/reach_plan.h"
#include "manipulation/target_geometry.h"
#include "manipulation/top_receptacle.h"

namespace simwright::manipulation {
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
constexpr double kFromBelow = 0.5;   // of the tool's axis, upwards
constexpr double kHasFallen = 0.7;   // of an object's upward axis, upwards
constexpr int kRestUpdates = 4;      // updates
constexpr int kOpeningUpdates = 10;  // updates that the gripper waits to open
constexpr int kStuckUpdates = 10;    // updates without progress; fingers open in 8
// m ahead of the gripper on the line of its retreat: the arm moves straight in joint space, and on
// a longer way fingers in a cup would leave the line and drag it along.
constexpr double kRetreatLead = 0.06;
constexpr int kLongestRetreat = 30;  // updates, 1.5 s at 20 Hz; an obstacle does not go away

// Returns TargetFrame::motion_direction for the frame at `world_from_target`.
Vector3d MotionDirection(const Interaction& interaction, const tasks::WorldState& state,
                         const Eigen::Isometry3d& world_from_target) {
  const InteractionTarget& target = *interaction.target;
  if (target.joint < 0) return Vector3d::Zero();
  const auto object = static_cast<size_t>(target.object), j = static_cast<size_t>(target.joint);
  const tasks::ObjectJoint& joint = interaction.model.objects[object].joints[j];
  const TargetGeometry geometry = GeometryOf(interaction.model, state, target, world_from_target);
  const bool turns = joint.type != reward::RewardJointType::kPrismatic;
  if (turns && geometry.hinge.norm() < kInPlace) return Vector3d::Zero();
  const double described = interaction.start.joints[object][j];
  return JointTarget(joint, described) > described ? geometry.motion_direction
                                                   : Vector3d(-geometry.motion_direction);
}

}  // namespace

TargetFrame::TargetFrame(const Interaction& interaction, const tasks::WorldState& state,
                         const Vector3d& across, double pitch, const Vector3d& retreat, int grasp)
    : interaction_(interaction), across_(across), grasp_(grasp) {
  if (!interaction_.target) return;
  (Pushes(interaction_) ? lean_ : pitch_) = pitch;
  // An object that is held by one of its grasps keeps its pose in the gripper.
  const bool keeps = grasp_ < 0 && interaction_.starts_held && interaction_.target->joint < 0 &&
                     !interaction_.target->grasps.empty() && state.grasped &&
                     state.touched == interaction_.target->object;
  world_from_target_ =
      keeps ? state.gripper : GraspPose(interaction_, state, across_, pitch_, grasp_);
  across_ = world_from_target_.linear().col(1);
  const Eigen::Isometry3d& root = state.roots[static_cast<size_t>(interaction_.target->object)];
  grasp_point_ = root.inverse() * world_from_target_.translation();
  at_destination_ = interaction_.starts_held && interaction_.destination;
  below_ = tasks::LinkPosition(interaction_.model, state, interaction_.target->object, 0).z() -
           tasks::WorldAabb(interaction_.model, state, interaction_.target->object).min().z();
  free_way_ = MotionDirection(interaction_, state, world_from_target_);
  axes_ = world_from_target_.linear();
  retreating_ = !retreat.isZero();
  retreat_ = Eigen::Translation3d(retreat) * state.gripper;
  before_ = state.gripper;
  Update(state);
  updates_withdrawing_ = 0;
}

void TargetFrame::UpdateAtDestination(const tasks::WorldState& state) {
  const bool held = state.grasped && state.touched == interaction_.target->object;
  held_ = held ? held_ + 1 : 0;
  if (held_ >= kGraspUpdates) at_destination_ = true;
  const Vector3d grasp =
      state.roots[static_cast<size_t>(interaction_.target->object)] * grasp_point_;
  const bool lost = (grasp - state.gripper.translation()).norm() > kLost;
  if (lost && !interaction_.starts_held) at_destination_ = false;
}

bool TargetFrame::Withdraws(const tasks::WorldState& state) {
  if (!retreating_) return false;
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
    retreating_ = false;
    world_from_target_.linear() = axes_;
  }
  return retreating_;
}

void TargetFrame::Turn(double angle, const tasks::WorldState& state) {
  const Eigen::AngleAxisd turn(angle, Vector3d::UnitZ());
  world_from_target_.linear() = turn * world_from_target_.linear();
  across_ = turn * across_;
  axes_ = turn * axes_;
  ComputeRetreat(state);
}

// The gripper enters and leaves a receptacle through its opening.
void TargetFrame::ComputeRetreat(const tasks::WorldState& state) {
  back_ = -Vector3d::UnitZ();
  retreat_distance_ = 0.0;
  if (at_destination_ && interaction_.destination->in_top_opening) {
    const Destination& room = *interaction_.destination;
    const double rim =
        tasks::WorldAabb(interaction_.model, state, room.object, room.link).max().z();
    const Vector3d object =
        tasks::LinkPosition(interaction_.model, state, interaction_.target->object, 0);
    const double bottom = object.z() + DisplacementToDestination(interaction_, state).z() - below_;
    back_ = world_from_target_.linear().transpose() * Vector3d::UnitZ();
    retreat_distance_ = std::max(0.0, rim + kRimClearance - bottom);
    return;
  }
  if (!interaction_.room) return;
  const SideReceptacle& room = *interaction_.room;
  const Vector3d point = world_from_target_.translation();
  const Vector3d object =
      tasks::LinkPosition(interaction_.model, state, interaction_.target->object, 0);
  const bool inside = IsIn(room, interaction_.model, state, point);
  if (!inside && !IsIn(room, interaction_.model, state, object)) return;
  const Vector3d displacement = DisplacementOutOfReceptacle(interaction_, state, point);
  back_ = world_from_target_.linear().transpose() * displacement.normalized();
  retreat_distance_ = displacement.norm();
}

// Returns the pose on the line of the retreat that is next for the gripper.
Eigen::Isometry3d TargetFrame::NextOfRetreat(const tasks::WorldState& state) const {
  const Vector3d way = retreat_.translation() - before_.translation();
  const double length = way.norm();
  const double done = (state.gripper.translation() - before_.translation()).dot(way) / length;
  Eigen::Isometry3d next = retreat_;
  next.translation() =
      before_.translation() + std::min(1.0, (std::max(0.0, done) + kRetreatLead) / length) * way;
  return next;
}

void TargetFrame::Update(const tasks::WorldState& state) {
  if (!interaction_.target) return;
  if (Withdraws(state)) {
    world_from_target_ = updates_opening_ < kOpeningUpdates ? before_ : NextOfRetreat(state);
    return;
  }
  Follow(state);
  ComputeRetreat(state);
}

// If the object has slipped in the grasp, it is off its destination when the gripper is at the
// frame: takes the current tool position as the new grasp point.
void TargetFrame::UpdateGraspPoint(const tasks::WorldState& state) {
  const Vector3d tool = state.gripper.translation();
  const bool rests = (tool - world_from_target_.translation()).norm() < kAtRest;
  updates_at_rest_ = state.grasped && rests ? updates_at_rest_ + 1 : 0;
  if (updates_at_rest_ < kRestUpdates ||
      DisplacementToDestination(interaction_, state).norm() < kSlid)
    return;
  grasp_point_ = state.roots[static_cast<size_t>(interaction_.target->object)].inverse() * tool;
  updates_at_rest_ = 0;
}

// Returns the rotation that makes the object upright as it is described, about a horizontal axis. A
// cup that hangs from its rim swings upright as it is set down. None for an object that has fallen,
// and in a side-opening receptacle, under whose ceiling a leaning gripper keeps it as it is.
Eigen::Quaterniond TargetFrame::Uprighting(const tasks::WorldState& state) const {
  if (interaction_.room) return Eigen::Quaterniond::Identity();
  const auto object = static_cast<size_t>(interaction_.target->object);
  const Vector3d up = interaction_.start.roots[object].linear().transpose() * Vector3d::UnitZ();
  const Vector3d now = state.roots[object].linear() * up;
  if (now.z() < kHasFallen) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond::FromTwoVectors(now, Vector3d::UnitZ());
}

// Returns the tool's place (m, world) with the object at its destination, upright.
Vector3d TargetFrame::PlaceAtDestination(const tasks::WorldState& state,
                                         const Vector3d& grasp) const {
  const Vector3d middle = tasks::LinkPosition(
      interaction_.model, state, interaction_.target->object, interaction_.target->link);
  return middle + DisplacementToDestination(interaction_, state) +
         Uprighting(state) * (grasp - middle);
}

// Turns the frame with an object that is moved before it is held. An object that has fallen over is
// not grasped from below: the frame then keeps its orientation.
void TargetFrame::FollowGrasp(const tasks::WorldState& state) {
  if (state.grasped && state.touched == interaction_.target->object) return;
  const Eigen::Isometry3d tool = GraspPose(interaction_, state, across_, pitch_, grasp_);
  if (tool.linear()(2, 2) > kFromBelow) return;
  world_from_target_.linear() = tool.linear();
  across_ = tool.linear().col(1);
}

void TargetFrame::Follow(const tasks::WorldState& state) {
  const InteractionTarget& target = *interaction_.target;
  if (target.joint >= 0 || Pushes(interaction_)) {
    world_from_target_ = GraspPose(interaction_, state, across_, pitch_);
    across_ = world_from_target_.linear().col(1);
    return;
  }
  if (interaction_.destination && interaction_.asks_for_grasp) UpdateAtDestination(state);
  // In a side-opening receptacle the gripper stays where it released the object: a rolling object
  // would lead it away.
  was_held_ = was_held_ || state.grasped;
  if (at_destination_ && interaction_.room && interaction_.starts_held && was_held_ &&
      !state.grasped) {
    return;
  }
  if (at_destination_) UpdateGraspPoint(state);
  if (grasp_ >= 0 && !at_destination_) FollowGrasp(state);
  const Vector3d grasp = state.roots[static_cast<size_t>(target.object)] * grasp_point_;
  world_from_target_.translation() = at_destination_ ? PlaceAtDestination(state, grasp) : grasp;
}

}  // namespace simwright::manipulation
