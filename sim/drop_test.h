#pragma once

#include <Eigen/Geometry>

#include "sim/rigid_body.h"

namespace simwright::sim {

struct DropOptions {
  double height = 0.01;      // m, initial height of the lowest point above the floor
  double settle_time = 2.0;  // s, within which the body must come to rest
  double drift_time = 2.0;   // s, of the drift measurement afterwards
  // The largest speed (m/s) of a resting body: over rest_window, no point moves farther than at
  // this speed. It is ODE's default for putting bodies to sleep, which also averages over some
  // steps. Slower creep shows in the drift.
  double rest_speed = 0.01;
  double rest_window = 0.1;                                 // s
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();  // orientation; shifted to `height`
};

// The result of a drop test. Angles exclude the rotation about the vertical, which is free.
struct DropResult {
  bool rests = false;         // it is at rest when settle_time ends
  double rest_time = 0.0;     // s, since when it is at rest; settle_time if it is not
  double tilt = 0.0;          // rad, between the vertical axis at the start and at rest
  double drift = 0.0;         // m, of the centre of mass over watch_time
  double early_drift = 0.0;   // m, the same over its first half
  double late_drift = 0.0;    // m, over the second half: smaller if the motion decays
  double fall = 0.0;          // m, largest drop of the centre of mass below its highest point
  double turn = 0.0;          // rad, over watch_time, about any axis
  double lowest_point = 0.0;  // m, at the end: below 0 is penetration
  Eigen::Isometry3d rest_pose = Eigen::Isometry3d::Identity();   // world_from_body after settling
  Eigen::Isometry3d final_pose = Eigen::Isometry3d::Identity();  // after the drift measurement
};

// Drops the body onto the plane z = 0 in Bullet (double precision, 240 Hz).
DropResult DropInBullet(const RigidBody& body, const DropOptions& options = {});

// Returns the angle (rad) between the body's vertical axes in two poses, ignoring yaw.
double TiltBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

// Accumulates a DropResult from the trajectory of any engine.
class DropObserver {
 public:
  DropObserver(const RigidBody& body, const DropOptions& options, const Eigen::Isometry3d& start);
  // Processes a step. Called once per step, with the time since the start.
  void Observe(double time, const Eigen::Isometry3d& world_from_body);
  DropResult Finish() const;

 private:
  const RigidBody& body_;
  DropOptions options_;
  Eigen::Isometry3d start_;
  double radius_;             // m, of the body about its centre of mass
  Eigen::Isometry3d anchor_;  // the pose at the start of the window
  double anchor_time_ = 0.0;  // s
  Eigen::Isometry3d half_;    // the pose after half of watch_time
  double highest_ = 0.0;      // m, of the centre of mass during watch_time
  DropResult result_;
};

// Returns the start pose: the lowest point at options.height, the centre of mass above the origin.
Eigen::Isometry3d StartPose(const RigidBody& body, const DropOptions& options);

}  // namespace simwright::sim
