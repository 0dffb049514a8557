#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace simwright::robot {

struct ArmJoint {
  std::string name;
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();  // at position zero
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();                      // joint frame, unit
  double lower = 0.0, upper = 0.0;                                      // rad
};

// A chain of revolute joints from a base to a tool. Constant; safe from several threads.
struct Arm {
  std::string name;
  std::vector<ArmJoint> joints;
  Eigen::Isometry3d last_from_tool = Eigen::Isometry3d::Identity();
  Eigen::VectorXd ready;  // (J) rad, within the limits: where a motion starts

  int size() const { return static_cast<int>(joints.size()); }
};

// base_from_tool at joint positions `q` (J, rad). Throws core::Error where q has another length.
Eigen::Isometry3d ForwardKinematics(const Arm& arm, const Eigen::VectorXd& q);

// The tool's velocity for each joint's: (6 x J), linear (m/rad) over angular, in the base's frame;
// column j is [z_j x (p - p_j); z_j]. Also gives the tool's pose. Throws as ForwardKinematics.
Eigen::Matrix<double, 6, Eigen::Dynamic> Jacobian(const Arm& arm, const Eigen::VectorXd& q,
                                                  Eigen::Isometry3d* base_from_tool);

}  // namespace simwright::robot
