#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/random.h"
#include "robot/arm.h"

namespace simwright::robot {

// The target of the tool, in the base frame.
struct ToolTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m
  std::optional<Eigen::Vector3d> approach;  // unit, the tool's z axis; rotation about it is free
};

struct InverseKinematicsOptions {
  double position_tolerance = 1e-3;  // m
  double approach_tolerance = 0.05;  // rad, between the tool's z and `approach`
  double damping = 0.05;             // damping factor: bounds the steps near singularities
  double angle_weight = 0.3;         // m/rad: weight of angular against linear error
  double longest_step = 0.4;         // rad, largest step of a joint: bounds the linearization error
  int iterations = 60;               // largest number of iterations per start
  int starts = 12;                   // the first at the ready configuration, the others random

  bool IsValid(std::string* error) const;
};

struct InverseKinematicsResult {
  bool reached = false;
  Eigen::VectorXd q;            // (J) rad, within the limits; the best start's
  double position_error = 0.0;  // m
  double approach_error = 0.0;  // rad; 0 where the approach is free
};

// Returns joint positions that bring the tool to `target`, by damped least squares (Wampler 1986),
// dq = J^T (J J^T + damping^2 I)^-1 e, clamped to the joint limits after each step, from several
// starts. A failure does not prove that no solution exists. Throws core::Error for invalid options
// or a target that is not finite.
InverseKinematicsResult SolveInverseKinematics(const Arm& arm, const ToolTarget& target,
                                               core::Rng& rng,
                                               const InverseKinematicsOptions& options = {});

}  // namespace simwright::robot
