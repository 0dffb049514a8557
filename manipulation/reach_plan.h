#pragma once

#include <optional>

#include "manipulation/interaction.h"
#include "manipulation/joint_path.h"

namespace simwright::manipulation {

// Returns the grasp pose (world_from_tool) at the target, or the pushing pose behind the object as
// seen from its destination. `across` (unit, world): the current closing axis, tool y, the line
// from finger to finger; the gripper is symmetric under a half turn about its own axis and stays
// near the given one. `pitch` (rad): the rotation of the gripper about that axis, about which a bar
// may be grasped at any angle. `grasp`: an index into InteractionTarget::grasps, whose pose is
// returned without regard to `pitch`; -1: none.
Eigen::Isometry3d GraspPose(const Interaction& interaction, const tasks::WorldState& state,
                            const Eigen::Vector3d& across, double pitch, int grasp = -1);

// The plan for reaching and manipulating a target.
struct ReachPlan {
  double pitch = 0.0;                      // rad, of the gripper
  int grasp = -1;                          // index into InteractionTarget::grasps; -1: none of them
  robot::JointVector grasp_configuration;  // (J) the grasp configuration
  bool clear = false;         // the straight joint path to the pre-grasp is collision-free
  JointPath waypoints;        // else the waypoints to the pre-grasp; empty: none found
  bool reaches_next = false;  // the object can be carried on to interaction.next

  bool IsReachable() const { return clear || !waypoints.empty(); }
};

// The options of the joint path to the pre-grasp.
struct PathOptions {
  bool round = false;   // search ReachPlan::via if no plan is clear
  bool part = false;    // if that fails: plan the first half of a push only
  double margin = 0.0;  // m, clearance to objects half-way (CollisionChecker::SetClearance)
};

// Plans the approach and the manipulation of the target. Tries approach pitches in the order of
// their preference (0 first; for pushing about 0.6 rad; for a side-opening receptacle about 0.8
// rad, leaning into it) and among several configurations prefers the one that is reached soonest
// from `from`. The tool must be able to follow most of the joint's range, or to carry the object to
// its destination, within 1 cm and 0.15 rad, and the arm must be collision-free in a receptacle and
// in front of it. Plans that are clear are preferred: for round objects the closing axis may turn
// for it. If possible, the object is grasped such that it can be carried on to interaction.next
// too. If the target has proved grasps, the most promising ones are tried before grasps from above
// (RankGrasps). With `path_options`.round, searches waypoints around obstacles if no plan is clear.
// None if no grasp and no pitch is feasible. Configurations are computed for both sides of the
// gripper, from `from` and from random ones: a tool that only tracks a straight line to its target
// ends at a joint limit every other time.
std::optional<ReachPlan> PlanReach(const PlanningArm& context, const Interaction& interaction,
                                   const tasks::WorldState& state, const robot::JointVector& from,
                                   core::Rng& rng, const PathOptions& path_options = {});

// Returns the displacement (m, world) from `point` in interaction.room out of the receptacle, to in
// front of its opening. It is straight; for a rim grasp, with one finger inside, it also rises. The
// approach reverses it.
Eigen::Vector3d DisplacementOutOfReceptacle(const Interaction& interaction,
                                            const tasks::WorldState& state,
                                            const Eigen::Vector3d& point);

// Returns the pre-grasp configuration (J) for the grasp configuration `grasp_configuration` (J).
robot::JointVector PreGraspConfiguration(const PlanningArm& context, const Interaction& interaction,
                                         const tasks::WorldState& state,
                                         const robot::JointVector& grasp_configuration);

// Returns the orientation tolerance (rad) of the tool as it moves the target: larger where fingers
// push a door or lid shut (InteractionTarget::pushes).
double OrientationTolerance(const Interaction& interaction);

// Returns the pitch (rad, as in PlanReach) of the gripper at `world_from_tool`: the rotation about
// its own y axis.
double PitchOf(const Eigen::Isometry3d& world_from_tool);

}  // namespace simwright::manipulation
