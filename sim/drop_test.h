#pragma once

#include <Eigen/Geometry>

#include "sim/rigid_body.h"

namespace simwright::sim {

struct DropOptions {
  double height = 0.01;      // m, of the lowest point above the floor at the start
  double settle_time = 2.0;  // s, within which it has to come to rest
  double watch_time = 2.0;   // s, over which the drift is measured afterwards
  // m/s: a body rests while, over rest_window, none of its points gets further from where it was
  // than this speed would take it. The speed is ODE's default for putting bodies to sleep, which
  // also takes the mean over some steps. Creep below it shows in the drift.
  double rest_speed = 0.01;
  double rest_window = 0.1;                                 // s
  Eigen::Isometry3d start = Eigen::Isometry3d::Identity();  // orientation; shifted to `height`
};

// What became of a dropped body. Angles leave the turn about the vertical out: a body may end up
// facing elsewhere.
struct DropResult {
  bool rests = false;         // it rested when settle_time ended
  double rest_time = 0.0;     // s, since when it rests; settle_time where it does not
  double tilt = 0.0;          // rad, between the start's and the resting vertical
  double drift = 0.0;         // m, of the centre of mass over watch_time
  double early_drift = 0.0;   // m, the same over its first half
  double late_drift = 0.0;    // m, and over its second half: less than before where it slows down
  double fall = 0.0;          // m, how far the centre of mass sank below where it had been highest
  double turn = 0.0;          // rad, over watch_time, about any axis
  double lowest_point = 0.0;  // m, at the end: below 0 is penetration
  Eigen::Isometry3d rest_pose = Eigen::Isometry3d::Identity();   // world_from_body after settling
  Eigen::Isometry3d final_pose = Eigen::Isometry3d::Identity();  // after watching
};

// Drops the body onto the plane z = 0 in Bullet (double precision, 240 Hz).
DropResult DropInBullet(const RigidBody& body, const DropOptions& options = {});

// Angle between the body's vertical axes in two poses, rad: the yaw is free.
double TiltBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b);

// Gathers a DropResult from the trajectory of any engine.
class DropWatch {
 public:
  DropWatch(const RigidBody& body, const DropOptions& options, const Eigen::Isometry3d& start);
  // Called once a step, with the time since the start.
  void Observe(double time, const Eigen::Isometry3d& world_from_body);
  DropResult Finish() const;

 private:
  const RigidBody& body_;
  DropOptions options_;
  Eigen::Isometry3d start_;
  double radius_;             // m, of the body about its centre of mass
  Eigen::Isometry3d anchor_;  // where it was at the start of the window
  double anchor_time_ = 0.0;  // s
  Eigen::Isometry3d half_;    // where it was when half of the watching was over
  double highest_ = 0.0;      // m, of the centre of mass since it was first watched
  DropResult result_;
};

// The start pose, moved so that the lowest point is at options.height and the centre of mass over
// the origin.
Eigen::Isometry3d StartPose(const RigidBody& body, const DropOptions& options);

}  // namespace simwright::sim
