#include "robot/inverse_kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "core/error.h"

namespace simwright::robot {
namespace {

struct ToolError {
  Eigen::Matrix<double, 6, 1> vector = Eigen::Matrix<double, 6, 1>::Zero();
  double position = 0.0;  // m
  double approach = 0.0;  // rad
};

ToolError ErrorOf(const Eigen::Isometry3d& base_from_tool, const ToolTarget& target,
                  double angle_weight) {
  ToolError error;
  error.vector.head<3>() = target.position - base_from_tool.translation();
  error.position = error.vector.head<3>().norm();
  if (target.approach) {
    const Eigen::Vector3d z = base_from_tool.linear().col(2);
    const Eigen::Vector3d cross = z.cross(*target.approach);
    const double sine = cross.norm(), cosine = z.dot(*target.approach);
    error.approach = std::atan2(sine, cosine);
    // Opposite to the target any perpendicular axis is valid.
    const Eigen::Vector3d axis =
        sine > 1e-9 ? Eigen::Vector3d(cross / sine) : base_from_tool.linear().col(0);
    error.vector.tail<3>() = angle_weight * error.approach * axis;
  }
  return error;
}

Eigen::VectorXd RandomConfiguration(const Arm& arm, core::Rng& rng) {
  Eigen::VectorXd q(arm.size());
  for (int j = 0; j < arm.size(); ++j) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
    q[j] = core::Uniform(rng, joint.lower, joint.upper);
  }
  return q;
}

// Iterates from one start; writes the final errors to `result`.
void Iterate(const Arm& arm, const ToolTarget& target, const InverseKinematicsOptions& options,
             InverseKinematicsResult* result) {
  for (int i = 0;; ++i) {
    Eigen::Isometry3d tool;
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian = Jacobian(arm, result->q, &tool);
    const ToolError error = ErrorOf(tool, target, options.angle_weight);
    result->position_error = error.position;
    result->approach_error = error.approach;
    result->reached = error.position <= options.position_tolerance &&
                      error.approach <= options.approach_tolerance;
    if (result->reached || i == options.iterations) return;
    jacobian.bottomRows<3>() *= target.approach ? options.angle_weight : 0.0;
    Eigen::Matrix<double, 6, 6> normal = jacobian * jacobian.transpose();
    normal.diagonal().array() += options.damping * options.damping;
    Eigen::VectorXd step = jacobian.transpose() * normal.ldlt().solve(error.vector);
    const double largest = step.cwiseAbs().maxCoeff();
    if (largest > options.longest_step) step *= options.longest_step / largest;
    for (int j = 0; j < arm.size(); ++j) {
      const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
      result->q[j] = std::clamp(result->q[j] + step[j], joint.lower, joint.upper);
    }
  }
}

}  // namespace

bool InverseKinematicsOptions::IsValid(std::string* error) const {
  const char* wrong = nullptr;
  if (!(position_tolerance > 0.0)) wrong = "position_tolerance must be above 0";
  if (!(approach_tolerance > 0.0)) wrong = "approach_tolerance must be above 0";
  if (!(damping > 0.0)) wrong = "damping must be above 0";
  if (!(angle_weight > 0.0)) wrong = "angle_weight must be above 0";
  if (!(longest_step > 0.0)) wrong = "longest_step must be above 0";
  if (iterations < 1 || starts < 1) wrong = "iterations and starts must be at least 1";
  if (wrong != nullptr && error != nullptr) *error = wrong;
  return wrong == nullptr;
}

InverseKinematicsResult SolveInverseKinematics(const Arm& arm, const ToolTarget& target,
                                               core::Rng& rng,
                                               const InverseKinematicsOptions& options) {
  std::string wrong;
  if (!options.IsValid(&wrong)) throw core::Error(wrong, "inverse kinematics");
  if (!target.position.allFinite() || (target.approach && !target.approach->allFinite())) {
    throw core::Error("the target is not finite", "inverse kinematics");
  }
  InverseKinematicsResult best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < options.starts; ++start) {
    InverseKinematicsResult result;
    result.q = start == 0 ? arm.ready : RandomConfiguration(arm, rng);
    Iterate(arm, target, options, &result);
    const double cost = result.position_error + options.angle_weight * result.approach_error;
    if (cost < least) {
      least = cost;
      best = result;
    }
    if (result.reached) return result;
  }
  return best;
}

}  // namespace simwright::robot
