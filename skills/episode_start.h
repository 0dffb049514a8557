#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/random.h"
#include "robot/chain_kinematics.h"
#include "skills/skill.h"

namespace simwright::skills {

// The start state of an episode.
struct StartState {
  int variant = 0;
  tasks::WorldState state;  // objects and joints; the gripper's part is ignored
  robot::JointVector arm;   // (J)
  double leader = 0.0;      // position of the gripper's first joint
  // The approach pitch of the gripper (rad) and the grasp configuration of the arm (J), from
  // PlanReach.
  double pitch = 0.0;
  robot::JointVector grasp_configuration;
  int grasp = -1;  // index into InteractionTarget::grasps, from PlanReach; -1: none
  // The displacement (m, world) by which an empty gripper retreats from where the previous skill
  // ended before it approaches its target (TargetFrame). Zero: no retreat.
  Eigen::Vector3d retreat = Eigen::Vector3d::Zero();
  // The waypoints (J) before the grasp configuration, if the straight joint path is blocked.
  std::vector<robot::JointVector> waypoints;
  int held = -1;  // the object that the gripper grasps before the episode; -1: none
  // The position of the gripper's first joint to which the gripper closes at its target before the
  // episode, unless an object between the fingers stops it. Set in easier start states.
  std::optional<double> closed_to;
  std::vector<double> mass;  // factors, by object
  std::vector<double> friction;
  std::vector<double> joint;              // factors of joint friction and damping
  int delay = 0;                          // control steps
  std::optional<double> finger_friction;  // of the fingers; none: the robot's own
};

// Samples a start state of the skill: a variant, and poses of its objects within the ranges of the
// options such that no AABBs overlap, the arm is collision-free and its manipulation is feasible
// (PlanReach); joints and gripper follow the shares of easier start states. Falls back to the
// described start state after 60 tries; later tries move everything away from the robot by up to
// 0.4 m, or towards it by up to 0.2 m. For the first skill of a task, prefers start states in which
// later skills are reachable too (IsDownstreamReachable).
StartState SampleStart(const Skill& skill, core::Rng& rng);

// Returns the opening (m) of the fingers before they close on the target: that of the planned
// grasp, else the gripper's largest.
double OpeningFor(const Skill& skill, const StartState& start);

// Returns the movable object that both fingers grasp; -1: none.
int HeldObject(const SkillVariant& variant, const tasks::WorldState& state);

enum class Resampling {
  kEverything,  // masses, frictions and delay are resampled, an empty arm is perturbed
  kNothing,     // only the manipulation is planned again
};

// Returns `start` as a start state of this skill, with its manipulation planned from there. `start`
// may be the end state of another skill in the same scene.
StartState PlannedFrom(const Skill& skill, const StartState& start, core::Rng& rng,
                       Resampling parts = Resampling::kEverything);

}  // namespace simwright::skills
