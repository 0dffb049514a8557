#pragma once

#include <numbers>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/random.h"
#include "robot/arm.h"
#include "robot/chain_kinematics.h"

namespace simwright::robot {

// The distance between two poses.
struct PoseError {
  double position = 0.0;  // m
  double angle = 0.0;     // rad, of the relative rotation, in [0, pi]
};

struct PoseInverseKinematicsOptions {
  double position_tolerance = 1e-3;                       // m
  double angle_tolerance = 0.5 * std::numbers::pi / 180;  // rad
  double angle_weight = 0.3;    // m/rad: weight of angular against linear error
  double min_damping = 1e-5;    // m^2: damping at the target
  double longest_step = 0.5;    // rad or m, largest joint step of an iteration
  int iterations = 40;          // per start of Solve, at most
  int starts = 30;              // of Solve: the first at the given configuration, the others random
  int samples_per_start = 8;    // random configurations per start; the nearest is used
  int tracking_iterations = 2;  // per call of Track
  double rest_gain = 0.02;      // fraction of the null-space displacement to `rest` per call of
                                // Track

  bool IsValid(std::string* error) const;
};

struct PoseSolution {
  bool reached = false;  // true if both tolerances are met
  JointVector q;         // (J) rad or m, within the limits; the best found
  PoseError error;
  int starts = 0;      // number of starts used
  int iterations = 0;  // summed over all starts
};

// Inverse kinematics of a tool pose by damped least squares on SE(3), dq = J^T (J J^T + lambda
// I)^-1 e with lambda = |e|^2 / 2 + least_damping (Sugihara, T-RO 2011, solvability-unconcerned
// inverse kinematics): an unreachable pose is approached as closely as possible. A joint at a limit
// that the step would exceed is removed from the step. No allocation after construction; immutable
// and thread-safe.
class PoseInverseKinematics {
 public:
  // Throws core::Error for invalid options, an arm without a ready configuration, or an arm that
  // ChainKinematics rejects.
  explicit PoseInverseKinematics(const Arm& arm, const PoseInverseKinematicsOptions& options = {});

  // Performs one control step: moves `q` (J) towards `base_from_tool`. The step is scaled so that
  // no joint exceeds its entry of `longest_step` (J, rad or m, above 0), and stays within the joint
  // limits (a `q` outside is first clamped). A redundant arm drifts to `rest` (J; null: the home
  // configuration) in the null space, less the farther the tool is from its target. Returns the
  // remaining error. Repeated calls with one target converge, whether it is reachable or not.
  // Requires finite values and vectors of the arm's length.
  PoseError Track(const Eigen::Isometry3d& base_from_tool, const JointVector& longest_step,
                  JointVector* q, const JointVector* rest = nullptr) const;

  // Solves from `start` (J), then from random configurations, until both tolerances are met. A
  // failure does not prove that no solution exists. Throws core::Error for a target or start that
  // is not finite or of another length.
  PoseSolution Solve(const Eigen::Isometry3d& base_from_tool, const JointVector& start,
                     core::Rng& rng) const;

  PoseError ErrorAt(const Eigen::Isometry3d& base_from_tool, const JointVector& q) const;

 private:
  struct Target;
  struct Work;
  void Evaluate(const Target& target, const JointVector& q, Work* work) const;
  // Adds a null-space displacement to the step: `rest_gain` times the displacement to `rest`,
  // projected so that the tool does not move.
  void Step(const JointVector& q, const JointVector& rest, double rest_gain, Work* work) const;
  bool Reached(const PoseError& error) const;
  void Descend(const Target& target, PoseSolution* solution) const;
  JointVector SampleStart(const Target& target, core::Rng& rng) const;
  void Clamp(JointVector* q) const;

  PoseInverseKinematicsOptions options_;
  ChainKinematics chain_;
  JointVector lower_, upper_, home_;
};

}  // namespace simwright::robot
