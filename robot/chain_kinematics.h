#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/arm.h"

namespace simwright::robot {

// The largest number of joints of a controlled arm: its vectors are stored without allocation.
constexpr int kMostJoints = 12;
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;
using ToolJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostJoints>;

// Forward kinematics and Jacobian of an arm, precomputed for many evaluations: the same numbers as
// ForwardKinematics and Jacobian up to rounding, without allocation or checks. Immutable and
// thread-safe.
class ChainKinematics {
 public:
  // Throws core::Error if the arm has no joints or more than kMostJoints.
  explicit ChainKinematics(const Arm& arm);

  int size() const { return static_cast<int>(joints_.size()); }
  // Returns base_from_tool at `q` (J, rad or m).
  Eigen::Isometry3d Tool(const JointVector& q) const;
  // Returns base_from_tool and writes the geometric Jacobian (6 x J), as Jacobian does.
  Eigen::Isometry3d Tool(const JointVector& q, ToolJacobian* jacobian) const;

 private:
  // The rotation of a joint frame at angle a relative to the previous joint frame is fixed + sin(a)
  // * sine + (1 - cos(a)) * versine (Rodrigues' formula, expanded).
  struct Joint {
    Eigen::Matrix3d fixed, sine, versine;
    Eigen::Vector3d offset, axis;
    bool prismatic;
  };
  void Advance(const Joint& joint, double position, Eigen::Matrix3d* rotation,
               Eigen::Vector3d* origin) const;

  std::vector<Joint> joints_;
  Eigen::Isometry3d last_from_tool_;
};

}  // namespace simwright::robot
