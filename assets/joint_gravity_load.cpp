#include "assets/joint_gravity_load.h"

#include <vector>

namespace simwright::assets {
namespace {

constexpr double kJointGravityLoadGravity = 9.81;  // m/s^2

}  // namespace

JointLoad LoadOn(const KinematicModel& model, int joint, double position) {
  const size_t index = static_cast<size_t>(joint);
  const std::vector<Joint>& joints = model.joints();
  const std::vector<bool> carried = model.Subtree(joint + 1);
  std::vector<Eigen::Isometry3d> poses(model.links().size(), Eigen::Isometry3d::Identity());
  for (size_t i = 0; i < joints.size(); ++i) {
    poses[i + 1] = poses[static_cast<size_t>(model.parents()[i])] * joints[i].parent_from_joint *
                   JointMotion(joints[i], i == index ? position : 0.0);
  }
  const Eigen::Vector3d pivot = poses[index + 1].translation();
  const Eigen::Vector3d axis = poses[index + 1].linear() * joints[index].axis;
  JointLoad load;
  for (size_t i = 0; i < carried.size(); ++i) {
    const Inertial& inertial = model.links()[i].inertial;
    if (!carried[i] || !(inertial.mass > 0.0)) continue;
    const Eigen::Vector3d lever = poses[i] * inertial.center_of_mass - pivot;
    const Eigen::Vector3d weight(0.0, 0.0, -kJointGravityLoadGravity * inertial.mass);
    load.mass += inertial.mass;
    if (joints[index].type == JointType::kPrismatic) {
      load.inertia += inertial.mass;
      load.gravity += weight.dot(axis);
    } else {
      const Eigen::Matrix3d turned =
          poses[i].linear() * inertial.inertia * poses[i].linear().transpose();
      load.inertia += axis.dot(turned * axis) + inertial.mass * lever.cross(axis).squaredNorm();
      load.gravity += lever.cross(weight).dot(axis);
    }
  }
  return load;
}

}  // namespace simwright::assets
