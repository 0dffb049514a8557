#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "rl/skill.h"
#include "robot/robot_model.h"

namespace simwright::rl {

// What the hand was asked for by the last action.
struct ToolTarget {
  Eigen::Isometry3d base_from_tool = Eigen::Isometry3d::Identity();
  robot::Posture joints;  // (J), with ActionSpace::kJoints
  double leader = 0.0;    // the gripper's first joint
};

// How many numbers an action has: 7, or one more than the arm's joints.
int ActionSize(const Skill& skill);

// Where the arm is sent. Mutable, one an episode.
struct ArmCommand {
  robot::Posture goal;  // (J) the posture in which the tool is where the action wants it
  robot::Posture sent;  // (J) what the motors hold now: on its way to `goal`
  // (J) that it goes through before, whatever the action wants meanwhile (PlanDetour).
  std::vector<robot::Posture> via;
  robot::Posture rest;  // (J) to which joints that are to spare drift; empty: home
  robot::Posture rate;  // (J) per s: how fast `sent` moves
  double pace = 1.0;    // of the speeds and accelerations that it may move with
  double leader = 0.0;  // the gripper's first joint
  double leader_rate = 0.0;
};

// What ActionSpace::kFocus is seen from.
struct WorkFrame {
  Eigen::Isometry3d base_from_focus = Eigen::Isometry3d::Identity();
  double lean = 0.0;  // rad about the focus' y axis, of the tool at work
  // Whether x is the way that a thing in front of the focus is pushed: the hand comes down behind
  // it before it goes forward.
  bool pushes = false;
  // Of length 1 at most, in the focus' frame: so much of being off that way is not being off to a
  // side (FocusFrame).
  Eigen::Vector3d free_way = Eigen::Vector3d::Zero();
  // Where the tool stays back to while it is off to a side (unit, the focus' frame): along its own
  // axis, or out of the room that the focus is in, as far as that is deep (m; 0: as options say).
  Eigen::Vector3d back = -Eigen::Vector3d::UnitZ();
  double room_depth = 0.0;
};

// What `action` (A, in [-1, 1]) asks for. `command`: where arm and fingers were sent last.
ToolTarget TargetOf(const Skill& skill, const float* action, const WorkFrame& frame,
                    const ArmCommand& command);

// Moves the command towards the target by one control step, within the speeds of options and
// joints, within the joints' accelerations, so that it can stop at its goal, and no farther than
// options.longest_lead from the joints' positions `actual` where it can still stop. What is learnt
// so is what a real arm's controller lets through. The goal follows the target from posture to
// posture, the arm follows the goal joint by joint: it never gets stuck at a limit between two ways
// of reaching one place.
void Approach(const Skill& skill, const ToolTarget& target, const robot::Posture& actual,
              ArmCommand* command);

}  // namespace simwright::rl
