#include "robot/chain_kinematics.h"

#include <cmath>

#include "core/error.h"

namespace simwright::robot {
namespace {

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

Eigen::Isometry3d Pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& origin) {
  Eigen::Isometry3d pose;
  pose.linear() = rotation;
  pose.translation() = origin;
  pose.makeAffine();
  return pose;
}

}  // namespace

ChainKinematics::ChainKinematics(const Arm& arm) : last_from_tool_(arm.last_from_tool) {
  if (arm.size() < 1 || arm.size() > kMostJoints) {
    throw core::Error("the arm has " + std::to_string(arm.size()) + " joints", arm.name,
                      "1 to " + std::to_string(kMostJoints) + " can be controlled");
  }
  for (const ArmJoint& joint : arm.joints) {
    const Eigen::Matrix3d fixed = joint.parent_from_joint.linear();
    const Eigen::Matrix3d cross = CrossMatrix(joint.axis);
    joints_.push_back({fixed, fixed * cross, fixed * cross * cross,
                       joint.parent_from_joint.translation(), joint.axis, joint.prismatic});
  }
}

inline void ChainKinematics::Advance(const Joint& joint, double position, Eigen::Matrix3d* rotation,
                                     Eigen::Vector3d* origin) const {
  origin->noalias() += *rotation * joint.offset;
  Eigen::Matrix3d local = joint.fixed;
  if (joint.prismatic) {
    const Eigen::Vector3d slide = position * (joint.fixed * joint.axis);
    origin->noalias() += *rotation * slide;
  } else {
    local += std::sin(position) * joint.sine + (1.0 - std::cos(position)) * joint.versine;
  }
  *rotation = *rotation * local;
}

Eigen::Isometry3d ChainKinematics::Tool(const JointVector& q) const {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int j = 0; j < size(); ++j) {
    Advance(joints_[static_cast<std::size_t>(j)], q[j], &rotation, &origin);
  }
  return Pose(rotation, origin) * last_from_tool_;
}

Eigen::Isometry3d ChainKinematics::Tool(const JointVector& q, ToolJacobian* jacobian) const {
  jacobian->resize(6, size());
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (int j = 0; j < size(); ++j) {
    const Joint& joint = joints_[static_cast<std::size_t>(j)];
    Advance(joint, q[j], &rotation, &origin);
    // A joint's axis is unchanged by its own rotation; the upper half holds the joint origin until
    // the tool position is known.
    jacobian->col(j).head<3>() = origin;
    jacobian->col(j).tail<3>().noalias() = rotation * joint.axis;
  }
  const Eigen::Isometry3d tool = Pose(rotation, origin) * last_from_tool_;
  for (int j = 0; j < size(); ++j) {
    const Eigen::Vector3d axis = jacobian->col(j).tail<3>();
    if (joints_[static_cast<std::size_t>(j)].prismatic) {
      jacobian->col(j).head<3>() = axis;
      jacobian->col(j).tail<3>().setZero();
    } else {
      const Eigen::Vector3d lever = tool.translation() - jacobian->col(j).head<3>();
      jacobian->col(j).head<3>() = axis.cross(lever);
    }
  }
  return tool;
}

}  // namespace simwright::robot
