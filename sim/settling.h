#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/rigid_body.h"

namespace simwright::sim {

// A body of a scene that settles under gravity.
struct SettlingBody {
  const RigidBody* body = nullptr;  // not null; may be shared
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
  bool fixed = false;  // welded furniture
};

struct SettlingOptions {
  double duration = 2.5;  // s; errors of millimetres have settled by then
  double watch = 2.0;     // s, of the stability check afterwards
  // The angle (rad) by which gravity tilts, once around, in the first `gravity_tilt_time` (s):
  // topples balanced objects.
  double gravity_tilt = 0.0;
  double gravity_tilt_time = 0.1;
  // The friction factor during settling: below 1, resting objects have a friction margin.
  double settling_friction = 1.0;
  // s. Stacks of five are stable at 1 ms; at 240 Hz the upper ones creep.
  double time_step = 1e-3;
  int solver_iterations = 50;
  double stable = 1e-3;  // m, largest displacement of a stable object during `watch`
  // The rest tolerance: settling ends early when no object moves farther than this (m) in 0.1 s; 0:
  // never early. At that speed an object would reach the limit of `stable` by the end of `watch`,
  // so that the stability check detects slow creep.
  double rest_tolerance = 5e-5;
  // The early-stop drift factor: the stability check ends after a quarter of a second or more if
  // the drift would stay below `stable` until its end at a multiple of its mean speed: this factor
  // at first, decreasing to 1 at the end; and as soon as one object has drifted farther. 0: never
  // before the end of `watch`.
  double early_stop_factor = 4.0;
  // m below its initial height: a lower object has fallen off its support. It is removed, so that
  // it topples nothing and its rolling delays nobody; not if `rest_tolerance` is 0.
  double fall_distance = 0.05;

  bool IsValid(std::string* error) const;
};

// The result for one body. Displacements are the largest of any of its points (MaxDisplacement).
struct SettledBody {
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();  // after settling
  double moved = 0.0;   // m, displacement from the initial pose
  double tilted = 0.0;  // rad, tilt of its vertical axis from the initial pose
  // The largest displacement (m) during the stability check; extrapolated to its end if it ended
  // early. HUGE_VAL for removed bodies.
  double drift = 0.0;
  bool fell = false;    // it lost more than `fallen` in height
  bool stable = false;  // drift <= options.stable
};

// Lets bodies settle under gravity in Bullet, above the floor z = 0, then checks their stability,
// starting from zero velocities and an empty contact cache, like a simulator that loads the scene.
// Results are in the order of `bodies`; fixed bodies are unchanged. Bit-identical when repeated.
// Throws core::Error for invalid options, a free body without a mass, or poses that are not finite.
std::vector<SettledBody> Settle(const std::vector<SettlingBody>& bodies,
                                const SettlingOptions& options = {});

}  // namespace simwright::sim
