#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "manipulation/grasp.h"
#include "manipulation/side_receptacle.h"
#include "reward/reward_slot.h"
#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::manipulation {

// The interaction target of a subtask: a part that a joint moves, or a free object.
struct InteractionTarget {
  int object = -1, link = -1;
  int joint = -1;  // index into ArticulatedObject::joints; -1: the object itself is moved
  // True if the part is pushed along the tool's x axis; else it is grasped.
  bool pushes = false;
  // The grasp pose in the link's frame (m): tool z points towards the link, and tool y, the closing
  // axis, across the link's thin side; for a pushed part, the pose at which the tool pushes. If
  // `joint` is -1, only the origin is used: the object is grasped from above at any yaw, or pushed.
  Eigen::Isometry3d link_from_grasp = Eigen::Isometry3d::Identity();
  // All candidates for `link_from_grasp` at a part that a joint moves, the most natural first;
  // ChooseApproach selects one. Empty if `joint` is -1.
  std::vector<Eigen::Isometry3d> approaches;
  // The distance (m) along tool y from the origin of `link_from_grasp` to the grasp point on the
  // wall of a vessel that is too wide for the gripper. 0: the object is grasped in its middle.
  double rim = 0.0;
  // The proved grasps (docs/grasps.md) of a free object, in its frame, or of the part that the
  // joint moves, in its link's frame; the latter are among `approaches`. Empty: none are known, or
  // the target is not grasped.
  std::vector<Grasp> grasps;
};

// The place to which the reward program asks to move the target.
struct Destination {
  bool goal = false;           // true: the place is the value of get_goal_pose; the rest is unset
  int object = -1, link = -1;  // else in the receptacle of this link, or on the link if it has none
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // the place in the link's frame, m
  std::optional<SideReceptacle> room;               // the side-opening receptacle, if any
  bool in_top_opening = false;                      // true: in a top-opening receptacle
};

// Returns the interaction target of a subtask from `slots`, the inputs of its reward program: the
// joint whose state the program reads, else the object whose grasp it reads, else the object whose
// position or bounding box, or a link's, it reads. Returns nullopt if the program reads none of
// these. `opening`: m, the maximum gripper opening; `base`: m, the height of the robot's base.
std::optional<InteractionTarget> FindInteractionTarget(const tasks::WorldModel& model,
                                                       const tasks::WorldState& start,
                                                       const std::vector<reward::RewardSlot>& slots,
                                                       double opening, double base);

// Returns the destination from the inputs of the reward program: the goal if the program reads one,
// else, for a target without a joint, the first other object or link whose position or bounding box
// it reads. Returns nullopt if there is none.
std::optional<Destination> DestinationOf(const tasks::WorldModel& model,
                                         const tasks::WorldState& start,
                                         const InteractionTarget& target,
                                         const std::vector<reward::RewardSlot>& slots);

// Returns the grasp pose (world_from_tool, m) in `state` for a target with a joint.
Eigen::Isometry3d GraspPoseAtJoint(const tasks::WorldModel& model, const tasks::WorldState& state,
                                   const InteractionTarget& target);

// Returns the horizontal direction (yaw about the world's z axis, rad) along which `object` is
// narrowest, within pi/2 of the yaw `wished` (rad). Among directions whose width is within 2 mm of
// the smallest, returns the one nearest to `wished`: a round object may be grasped along any.
double ThinDirection(const tasks::ArticulatedObject& object,
                     const Eigen::Isometry3d& world_from_object, double wished);

// Returns the width (m) of `object` along the direction `across` (unit, world).
double WidthAlong(const tasks::ArticulatedObject& object,
                  const Eigen::Isometry3d& world_from_object, const Eigen::Vector3d& across);

}  // namespace simwright::manipulation
