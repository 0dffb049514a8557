#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "manipulation/side_receptacle.h"
#include "reward/reward_slot.h"
#include "tasks/scene_state.h"
#include "tasks/task.h"

namespace simwright::manipulation {

// The interaction target of a subtask: a part that a joint moves, or a free object.
struct InteractionTarget {
  int object = -1, link = -1;
  int joint = -1;  // into ArticulatedObject::joints; -1: the object itself is moved
  // True if the part is pushed along the tool's x axis; else it is grasped.
  bool pushes = false;
  // The grasp pose: tool z towards the link, tool y (the closing axis) across the link's thin
  // side. For an object without a joint only the origin is used; it is grasped from above in any
  // orientation.
  Eigen::Isometry3d link_from_grasp = Eigen::Isometry3d::Identity();
  // All grasp poses at a part, the most natural first (ChooseApproach selects one).
  std::vector<Eigen::Isometry3d> approaches;
  // The distance (m) from that origin to the grasp point on the wall of a vessel that is too wide
  // for the gripper, on the side that tool y points to. 0: the vessel is grasped in the middle.
  double rim = 0.0;
};

// The place to which the reward program moves the object, if it names one.
struct Destination {
  bool goal = false;           // at get_goal_pose
  int object = -1, link = -1;  // else at this link: in its receptacle if it has one, or on it
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, the link's frame
  std::optional<SideReceptacle> room;               // the side-opening receptacle, if any
  bool in_top_opening = false;                      // true for a top-opening receptacle
};

// Returns the interaction target of a subtask from the inputs of its program: the joint whose state
// it reads, else the object whose grasp it asks for, else the object or link whose position it
// reads. None if it names nothing. `opening`: m, the maximum gripper opening; `base`: m, the height
// of the robot's base.
std::optional<InteractionTarget> FindInteractionTarget(const tasks::SceneModel& model,
                                                       const tasks::SceneState& start,
                                                       const std::vector<reward::RewardSlot>& slots,
                                                       double opening, double base);

std::optional<Destination> DestinationOf(const tasks::SceneModel& model,
                                         const tasks::SceneState& start,
                                         const InteractionTarget& target,
                                         const std::vector<reward::RewardSlot>& slots);

// Returns the grasp pose (world_from_tool) for a target with a joint.
Eigen::Isometry3d GraspPoseAtJoint(const tasks::SceneModel& model, const tasks::SceneState& state,
                                   const InteractionTarget& target);

// Returns the direction (rad about z, in [-pi/2, pi/2)) across the thinnest side of `thing` at
// `world_from_thing`, seen from above. Among directions within 2 mm of the thinnest, returns the
// one nearest to `wished`, since a round object may be grasped along any.
double ThinDirection(const tasks::ArticulatedObject& object,
                     const Eigen::Isometry3d& world_from_object, double wished);

// Returns the width (m) of `thing` along `across` (unit, world).
double WidthAlong(const tasks::ArticulatedObject& object,
                  const Eigen::Isometry3d& world_from_object, const Eigen::Vector3d& across);

}  // namespace simwright::manipulation
