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
  double lower = 0.0, upper = 0.0;                                      // rad or m
  bool prismatic = false;                                               // slides along its axis
};

// joint-at-zero from joint-at-`position` (rad or m).
Eigen::Isometry3d JointMotion(const ArmJoint& joint, double position);

// A chain of joints that turn or slide, from a base to a tool. Constant; safe from several threads.
struct Arm {
  std::string name;
  std::vector<ArmJoint> joints;
  Eigen::Isometry3d last_from_tool = Eigen::Isometry3d::Identity();
  Eigen::VectorXd ready;  // (J) rad or m, within the limits: where a motion starts

  int size() const { return static_cast<int>(joints.size()); }
};

// base_from_tool at joint positions `q` (J, rad or m). Throws core::Error where q has another
// length.
Eigen::Isometry3d ForwardKinematics(const Arm& arm, const Eigen::VectorXd& q);

// The tool's velocity for each joint's: (6 x J), linear (m/rad) over angular, in the base's frame;
// column j is [z_j x (p - p_j); z_j], or [z_j; 0] where the joint slides. Also gives the tool's
// pose. Throws as ForwardKinematics.
Eigen::Matrix<double, 6, Eigen::Dynamic> Jacobian(const Arm& arm, const Eigen::VectorXd& q,
                                                  Eigen::Isometry3d* base_from_tool);

}  // namespace simwright::robot
