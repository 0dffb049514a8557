#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "robot/arm.h"

namespace simwright::robot {

// Of an arm that is controlled: room for its postures without allocation.
constexpr int kMostJoints = 12;
using Posture = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;
using ToolJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostJoints>;

// An arm made ready for many evaluations: the same numbers as ForwardKinematics and Jacobian, to
// rounding, without allocation and checks. Constant; safe from several threads.
class ChainKinematics {
 public:
  // Throws core::Error where the arm has no or more than kMostJoints joints.
  explicit ChainKinematics(const Arm& arm);

  int size() const { return static_cast<int>(joints_.size()); }
  // base_from_tool at `q` (J, rad or m).
  Eigen::Isometry3d Tool(const Posture& q) const;
  // The same, and the tool's velocity for each joint's (6 x J), as Jacobian gives it.
  Eigen::Isometry3d Tool(const Posture& q, ToolJacobian* jacobian) const;

 private:
  // Turned by a, a joint's frame stands in that of the one before as
  // fixed + sin(a) * sine + (1 - cos(a)) * versine: Rodrigues' formula, multiplied out.
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
