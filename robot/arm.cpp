#include "robot/arm.h"

#include "core/error.h"

namespace simwright::robot {
namespace {

void RequireLength(const Arm& arm, const Eigen::VectorXd& q) {
  if (q.size() == arm.size()) return;
  throw core::Error("got " + std::to_string(q.size()) + " joint positions, the arm has " +
                        std::to_string(arm.size()) + " joints",
                    arm.name);
}

}  // namespace

Eigen::Isometry3d JointMotion(const ArmJoint& joint, double position) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (joint.prismatic) {
    motion.translation() = position * joint.axis;
  } else {
    motion.linear() = Eigen::AngleAxisd(position, joint.axis).toRotationMatrix();
  }
  return motion;
}

Eigen::Isometry3d ForwardKinematics(const Arm& arm, const Eigen::VectorXd& q) {
  RequireLength(arm, q);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int j = 0; j < arm.size(); ++j) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
    pose = pose * joint.parent_from_joint * JointMotion(joint, q[j]);
  }
  return pose * arm.last_from_tool;
}

Eigen::Matrix<double, 6, Eigen::Dynamic> Jacobian(const Arm& arm, const Eigen::VectorXd& q,
                                                  Eigen::Isometry3d* base_from_tool) {
  RequireLength(arm, q);
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, arm.size());
  Eigen::Matrix<double, 3, Eigen::Dynamic> origins(3, arm.size());
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int j = 0; j < arm.size(); ++j) {
    const ArmJoint& joint = arm.joints[static_cast<std::size_t>(j)];
    pose = pose * joint.parent_from_joint;
    origins.col(j) = pose.translation();
    jacobian.col(j).tail<3>() = pose.linear() * joint.axis;
    pose = pose * JointMotion(joint, q[j]);
  }
  *base_from_tool = pose * arm.last_from_tool;
  for (int j = 0; j < arm.size(); ++j) {
    const Eigen::Vector3d axis = jacobian.col(j).tail<3>();
    if (arm.joints[static_cast<std::size_t>(j)].prismatic) {
      jacobian.col(j) << axis, Eigen::Vector3d::Zero();
      continue;
    }
    jacobian.col(j).head<3>() = axis.cross(base_from_tool->translation() - origins.col(j));
  }
  return jacobian;
}

}  // namespace simwright::robot
