#pragma once

#include <numbers>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/random.h"
#include "robot/arm.h"
#include "robot/chain_kinematics.h"

namespace simwright::robot {

// How far one pose is from another.
struct PoseError {
  double position = 0.0;  // m
  double angle = 0.0;     // rad, of the turn between them, in [0, pi]
};

struct PoseInverseKinematicsOptions {
  double position_tolerance = 1e-3;                       // m
  double angle_tolerance = 0.5 * std::numbers::pi / 180;  // rad
  double angle_weight = 0.3;    // m/rad: what a radian counts against a metre
  double least_damping = 1e-5;  // m^2: what is left of the damping at the target itself
  double longest_step = 0.5;    // rad or m of any joint in one iteration
  int iterations = 40;          // of one start of Solve, at most
  int starts = 30;              // of Solve: the first from the posture given, the others at random
  int drafts = 8;               // random postures of which a start takes the nearest
  int tracking_iterations = 2;  // of one call of Track
  double posture_gain = 0.02;   // of the way to rest that one call of Track goes where it is free

  bool IsValid(std::string* error) const;
};

struct PoseSolution {
  bool reached = false;  // both tolerances are met
  Posture q;             // (J) rad or m, within the limits; the best that was found
  PoseError error;
  int starts = 0;      // that were made
  int iterations = 0;  // of all starts
};

// Joint positions that bring an arm's tool to a pose. Damped least squares on SE(3),
// dq = J^T (J J^T + lambda I)^-1 e with lambda = |e|^2 / 2 + least_damping (Sugihara, T-RO 2011,
// solvability-unconcerned inverse kinematics), so that a pose out of reach is approached as near
// as can be; a joint that stands at a limit and is pushed against it is left out of the step. No
// allocation after construction; constant, safe from several threads.
class PoseInverseKinematics {
 public:
  // Throws core::Error for options that are not valid, an arm without a ready posture, or one
  // that ChainKinematics does not take.
  explicit PoseInverseKinematics(const Arm& arm, const PoseInverseKinematicsOptions& options = {});

  // One step of control: moves `q` (J) towards `base_from_tool`, no joint further than its entry
  // of `longest_step` (J, rad or m, above 0), all in proportion, and never out of its limits (a
  // `q` that lies outside is first put to the limit). Where the arm has joints to spare they drift
  // to `rest` (J; none: home), less the further the tool is from its target. Returns the error that
  // is left. Called again and again with one target it comes to rest, in reach or out of it.
  // Requires finite values and vectors of the arm's length.
  PoseError Track(const Eigen::Isometry3d& base_from_tool, const Posture& longest_step, Posture* q,
                  const Posture* rest = nullptr) const;

  // From `start` (J), then from random postures until both tolerances are met. Not finding one is
  // no proof that there is none. Throws core::Error for a target or start that is not finite or of
  // another length.
  PoseSolution Solve(const Eigen::Isometry3d& base_from_tool, const Posture& start,
                     core::Rng& rng) const;

  PoseError ErrorAt(const Eigen::Isometry3d& base_from_tool, const Posture& q) const;

 private:
  struct Target;
  struct Work;
  void Evaluate(const Target& target, const Posture& q, Work* work) const;
  // Drifts by `posture_gain` of the way to `rest`, as far as that leaves the tool where it is.
  void Step(const Posture& q, const Posture& rest, double posture_gain, Work* work) const;
  bool Reached(const PoseError& error) const;
  void Descend(const Target& target, PoseSolution* solution) const;
  Posture Draft(const Target& target, core::Rng& rng) const;
  void Clamp(Posture* q) const;

  PoseInverseKinematicsOptions options_;
  ChainKinematics chain_;
  Posture lower_, upper_, home_;
};

}  // namespace simwright::robot
