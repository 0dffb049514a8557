#pragma once

#include <string>
#include <vector>

#include "certificate/goal.h"
#include "certificate/placed_scene.h"
#include "robot/joint_trajectory.h"

namespace simwright::certificate {

class Planner;

struct ProofOptions {
  double time_step = 1.0 / 240.0;  // s
  int solver_iterations = 50;
  double others_tolerance = 0.005;  // m that any point of another object may move
  double hold = 0.5;                // s that the last command is held, and the goal must last
  // Bodies that the robot never comes nearer to than this (m) stay fixed, which halves the time:
  // those nearer may move by no more than `others_tolerance`. Infinity: all objects are free.
  double free_distance = 0.06;

  bool IsValid(std::string* error) const;
};

// A moment of a replay, for pictures.
struct ReplayMoment {
  double time = 0.0;  // s
  Eigen::VectorXd arm;
  double leader = 0.0;
  std::vector<Eigen::Isometry3d> poses;  // world_from_body, by body of the scene
};

// The result of driving the robot along a trajectory in a fresh world.
struct Proof {
  bool success = false;
  std::string failure;        // what happened, if it failed
  double others_moved = 0.0;  // m, the largest displacement of a point of another object ...
  std::string moved_most;     // ... and its name
  double slip = 0.0;          // m that the target has moved in the gripper since it was lifted
  double target_moved = 0.0;  // m
  bool held = false;          // both fingers press on the target at the end
  double seconds = 0.0;       // s simulated
  int free_bodies = 0;        // bodies that could move
  std::vector<ReplayMoment> moments;  // at the times asked for
};

// Drives the motors of a robot with the positions of `trajectory` alone, from home in a fresh
// Bullet world with the bodies of `scene` at their poses, and checks at the end, and for
// options.hold after it, that the target is at its goal: held by both fingers, or placed, released
// and at rest. Others may not move by more than options.others_tolerance at any time. The object is
// held by contact forces alone. Throws core::Error if the joints are not the robot's.
Proof Replay(const Planner& planner, const PlacedScene& scene, int target, const Goal& goal,
             const Eigen::Isometry3d& world_from_robot, const robot::JointTrajectory& trajectory,
             const std::vector<double>& moments = {}, const ProofOptions& options = {});

}  // namespace simwright::certificate
