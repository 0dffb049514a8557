#pragma once

#include <string>
#include <vector>

#include "tasks/scene_state.h"

namespace simwright::tasks {

enum class ActionKind {
  kReach,      // the gripper goes to a link
  kMoveJoint,  // takes what moves a joint, and moves it to `position`
  kCarry,      // takes a thing, brings its middle to `target`, keeps it
  kPlace,      // the same, and lets go
  kPush,       // pushes a thing along the floor until its middle is at `target`
  kTilt,       // takes a thing, lifts it to `target`, turns it over by `position`
};

// One thing that a hand can do.
struct Action {
  ActionKind kind = ActionKind::kReach;
  int thing = -1;
  int part = -1;                                     // link (kReach) or joint (kMoveJoint)
  double position = 0.0;                             // rad or m
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  // m, world
};

enum class MotionPhase { kApproach, kMove, kTurnOver, kRelease };

// A path of states, as an ideal hand would take it: what is held moves with the gripper, what
// stands in a drawer moves with the drawer. It is kinematic: nothing is in the way, nothing slips.
struct Motion {
  std::vector<SceneState> states;   // the start first
  std::vector<MotionPhase> phases;  // of the step that led to each state; the first: kApproach
};

// Seconds between two states of a motion: what velocities are taken over.
constexpr double kMotionTimeStep = 1.0 / 12.0;

// Carries `actions` out one after the other. Actions of things or joints that are out of range are
// the caller's mistake.
Motion MakeMotion(const SceneModel& model, const SceneState& start,
                  const std::vector<Action>& actions);

}  // namespace simwright::tasks
