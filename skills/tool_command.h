#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/robot_model.h"
#include "skills/skill.h"

namespace simwright::skills {

// The command of the last action.
struct ToolTarget {
  Eigen::Isometry3d base_from_tool = Eigen::Isometry3d::Identity();
  robot::JointVector joints;  // (J), with ActionSpace::kJoints and kJointTargets
  double leader = 0.0;        // position of the gripper's first joint
};

// Returns the size of an action: 7, or one more than the number of arm joints.
int ActionSize(const Skill& skill);

// The arm command. Mutable, one per episode.
struct ArmCommand {
  robot::JointVector goal;  // (J) the configuration at the tool pose of the action
  robot::JointVector sent;  // (J) the current motor set point, moving towards `goal`
  // The remaining waypoints (J) before `goal`, which do not depend on the action (PlanSimplePath).
  std::vector<robot::JointVector> waypoints;
  robot::JointVector rest;  // (J) the null-space target of redundant joints; empty: home
  robot::JointVector rate;  // (J) per s: velocity of `sent`
  double pace = 1.0;        // factor of the speed and acceleration limits
  // True: joints accelerate in proportion, so that the tool stays on its line from the start.
  bool together = false;
  double leader = 0.0;  // position of the gripper's first joint
  double leader_rate = 0.0;
};

// The frame of ActionSpace::kTargetFrame.
struct ActionFrame {
  Eigen::Isometry3d base_from_target = Eigen::Isometry3d::Identity();
  double lean = 0.0;  // rad about the target frame's y axis, of the tool at the target
  // True if x is the direction in which an object in front of the frame is pushed: the gripper
  // comes down behind it before it moves forward.
  bool pushes = false;
  // The direction in which a displacement does not count as lateral, scaled by its length (at most
  // 1; target frame; TargetFrame).
  Eigen::Vector3d motion_direction = Eigen::Vector3d::Zero();
  // The direction (unit, target frame) in which the tool stays back while it is laterally off:
  // along its own axis, or out of the receptacle around the frame, by at most `retreat_distance`
  // (m; 0: the options' standoff).
  Eigen::Vector3d back = -Eigen::Vector3d::UnitZ();
  double retreat_distance = 0.0;
};

// Returns the target of `action` (A, in [-1, 1]). `command`: the current command of arm and
// fingers.
ToolTarget ActionTarget(const Skill& skill, const float* action, const ActionFrame& frame,
                        const ArmCommand& command);

// Moves the command towards the target by one control step, within the velocity limits of options
// and joints, within the joints' accelerations, such that it can stop at its goal, and at most
// options.longest_lead ahead of the joint positions `actual` if it can still stop. A policy thus
// learns only motions that a real arm's controller accepts. The goal tracks the target continuously
// in configuration space, and the arm follows it joint by joint: it never gets stuck at a limit
// between two inverse kinematics branches.
void StepCommand(const Skill& skill, const ToolTarget& target, const robot::JointVector& actual,
                 ArmCommand* command);

}  // namespace simwright::skills
