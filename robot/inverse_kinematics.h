#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/random.h"
#include "robot/arm.h"

namespace simwright::robot {

// Where the tool shall be, in the base's frame.
struct ToolTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
  std::optional<Eigen::Vector3d> approach;  // unit, of the tool's z; its turn about it stays free
};

struct InverseKinematicsOptions {
  double position_tolerance = 1e-3;  // m
  double approach_tolerance = 0.05;  // rad, between the tool's z and `approach`
  double damping = 0.05;             // of the least squares: keeps steps bounded near singularities
  double angle_weight = 0.3;         // m/rad: what a radian counts against a metre
  double longest_step = 0.4;         // rad of any joint: beyond it the linearisation is no guide
  int iterations = 60;               // of one start
  int starts = 12;                   // the first from the ready posture, the others at random

  bool IsValid(std::string* error) const;
};

struct InverseKinematicsResult {
  bool reached = false;
  Eigen::VectorXd q;            // (J) rad, within the limits; of the best start
  double position_error = 0.0;  // m
  double approach_error = 0.0;  // rad; 0 where the approach is free
};

// Joint positions that bring the tool to `target`: damped least squares (Wampler 1986),
// dq = J^T (J J^T + damping^2 I)^-1 e, clamped to the joints' limits after each step, from several
// starts. Not finding one is no proof that there is none. Throws core::Error for invalid options
// or a target that is not finite.
InverseKinematicsResult SolveInverseKinematics(const Arm& arm, const ToolTarget& target,
                                               core::Rng& rng,
                                               const InverseKinematicsOptions& options = {});

}  // namespace simwright::robot
