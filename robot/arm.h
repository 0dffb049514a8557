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

// Returns the joint frame at `position` (rad or m) relative to the joint frame at position zero.
Eigen::Isometry3d JointMotion(const ArmJoint& joint, double position);

// A serial chain of revolute and prismatic joints from a base to a tool. Immutable and thread-safe.
struct Arm {
  std::string name;
  std::vector<ArmJoint> joints;
  Eigen::Isometry3d last_from_tool = Eigen::Isometry3d::Identity();
  Eigen::VectorXd ready;  // (J) rad or m, within the limits: the initial configuration

  int size() const { return static_cast<int>(joints.size()); }
};

// Returns base_from_tool at joint positions `q` (J, rad or m). Throws core::Error if the length of
// `q` is not J.
Eigen::Isometry3d ForwardKinematics(const Arm& arm, const Eigen::VectorXd& q);

// Returns the geometric Jacobian of the tool (6 x J): linear rows (m/rad) over angular rows, in the
// base frame. Column j is [z_j x (p - p_j); z_j] for a revolute joint and [z_j; 0] for a prismatic
// one. Also writes the tool pose to `base_from_tool`. Throws as ForwardKinematics.
Eigen::Matrix<double, 6, Eigen::Dynamic> Jacobian(const Arm& arm, const Eigen::VectorXd& q,
                                                  Eigen::Isometry3d* base_from_tool);

}  // namespace simwright::robot
