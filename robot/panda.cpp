#include "robot/panda.h"

#include <numbers>

namespace simwright::robot {
namespace {

constexpr double kQuarter = std::numbers::pi / 2.0;

ArmJoint PandaJoint(const std::string& name, const Eigen::Vector3d& origin, double roll,
                    double lower, double upper) {
  ArmJoint joint;
  joint.name = name;
  joint.parent_from_joint =
      Eigen::Translation3d(origin) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
  joint.lower = lower;
  joint.upper = upper;
  return joint;
}

Arm MakePanda() {
  Arm arm;
  arm.name = "panda";
  arm.joints = {
      PandaJoint("panda_joint1", {0, 0, 0.333}, 0, -2.8973, 2.8973),
      PandaJoint("panda_joint2", {0, 0, 0}, -kQuarter, -1.7628, 1.7628),
      PandaJoint("panda_joint3", {0, -0.316, 0}, kQuarter, -2.8973, 2.8973),
      PandaJoint("panda_joint4", {0.0825, 0, 0}, kQuarter, -3.0718, -0.0698),
      PandaJoint("panda_joint5", {-0.0825, 0.384, 0}, -kQuarter, -2.8973, 2.8973),
      PandaJoint("panda_joint6", {0, 0, 0}, kQuarter, -0.0175, 3.7525),
      PandaJoint("panda_joint7", {0.088, 0, 0}, kQuarter, -2.8973, 2.8973),
  };
  // The flange, then the hand rotated by 45 degrees, then the point between the fingertips.
  arm.last_from_tool = Eigen::Translation3d(0, 0, 0.107 + 0.1034) *
                       Eigen::AngleAxisd(-kQuarter / 2.0, Eigen::Vector3d::UnitZ());
  arm.ready.resize(7);
  arm.ready << 0, -kQuarter / 2, 0, -1.5 * kQuarter, 0, kQuarter, kQuarter / 2;
  return arm;
}

}  // namespace

const Arm& PandaArm() {
  static const Arm* arm = new Arm(MakePanda());
  return *arm;
}

}  // namespace simwright::robot
