#pragma once

#include <string>
#include <vector>

#include "tasks/world_state.h"

namespace simwright::tasks {

enum class ActionKind {
  kReach,      // the gripper moves to a link
  kMoveJoint,  // grasps the grip of a joint and moves the joint to `position`
  kCarry,      // grasps an object, moves its centre to `target`, and keeps holding it
  kPlace,      // the same, then releases it
  kPush,       // pushes an object along the floor until its centre is at `target`
  kTilt,       // grasps an object, lifts it to `target`, and tilts it by `position`
};

// A single manipulation action.
struct Action {
  ActionKind kind = ActionKind::kReach;
  int object = -1;
  int part = -1;                                     // link (kReach) or joint (kMoveJoint)
  double position = 0.0;                             // rad or m
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  // m, world
};

enum class MotionPhase { kApproach, kMove, kTurnOver, kRelease };

// A sequence of states produced by an ideal gripper: a held object moves with the gripper, the
// contents of a drawer move with the drawer. The motion is kinematic: it ignores collisions and
// slip.
struct Motion {
  std::vector<WorldState> states;   // begins with the start state
  std::vector<MotionPhase> phases;  // the phase of the step that led to each state; kApproach for
                                    // the first
};

// The time between two states of a motion, s; velocities are differences over it.
constexpr double kMotionTimeStep = 1.0 / 12.0;

// Returns the motion that carries out `actions` one after the other. The caller must pass valid
// indices of objects and joints.
Motion MakeMotion(const WorldModel& model, const WorldState& start,
                  const std::vector<Action>& actions);

}  // namespace simwright::tasks
