#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "manipulation/convex_part.h"
#include "manipulation/interaction_target.h"
#include "manipulation/side_receptacle.h"
#include "robot/pose_inverse_kinematics.h"
#include "robot/robot_model.h"
#include "sim/articulated_world.h"
#include "tasks/task.h"
#include "tasks/world_state.h"

namespace simwright::manipulation {

// The robot as planners see it. Constant; shared by all episodes.
struct PlanningArm {
  const robot::RobotModel* robot = nullptr;  // outlives this
  std::vector<SurfacePoints> robot_surface;  // by link of its URDF (RobotSurface)
  std::shared_ptr<const robot::PoseInverseKinematics> kinematics;
  std::shared_ptr<const robot::ChainKinematics> chain;
  double standoff = 0.12;  // m that the tool stays back along its own axis before it acts
};

// One scene, and the interaction with it that planners plan. Constant. The objects are those of
// `model`, in its order.
struct Interaction {
  tasks::WorldModel model;
  std::vector<std::shared_ptr<const sim::PreparedBody>> bodies;  // by object
  std::vector<BodyParts> solids;                                 // of the bodies
  tasks::Subtask subtask;
  tasks::WorldState start;  // as the subtask describes it
  std::vector<int> placed;  // the objects that the subtask places
  std::optional<InteractionTarget> target;
  std::optional<Destination> destination;
  // The place to which the next subtask brings the object that this one grasps: the grasp is chosen
  // so that it can be kept. None where the next subtask does not use the object, or uses it
  // elsewhere.
  std::optional<Destination> next;
  // The receptacle that the gripper enters: the destination's, the object's at the start, or that
  // of `next`.
  std::optional<SideReceptacle> room;
  bool asks_for_grasp = false;
  bool starts_held = false;
};

// Returns true if the object is pushed to its destination instead of being grasped.
inline bool Pushes(const Interaction& interaction) {
  return interaction.target && interaction.target->joint < 0 && interaction.destination &&
         !interaction.asks_for_grasp;
}

}  // namespace simwright::manipulation
