#include "assets/joint_gravity_load.h"

#include "assets/joint_poses.h"

namespace simwright::assets {
namespace {

constexpr double kJointGravityLoadGravity = 9.81;  // m/s^2

}  // namespace

JointLoad LoadOn(const std::vector<Inertial>& links, const std::vector<UrdfJoint>& joints,
                 const std::vector<int>& parents, int joint, double position) {
  const size_t index = static_cast<size_t>(joint);
  std::vector<Eigen::Isometry3d> poses(links.size(), Eigen::Isometry3d::Identity());
  std::vector<bool> carried(links.size(), false);
  for (size_t i = 0; i < joints.size(); ++i) {
    const size_t parent = static_cast<size_t>(parents[i]);
    poses[i + 1] = poses[parent] * joints[i].parent_from_joint *
                   JointMotion(joints[i], i == index ? position : 0.0);
    carried[i + 1] = i == index || carried[parent];
  }
  const Eigen::Vector3d pivot = poses[index + 1].translation();
  const Eigen::Vector3d axis = poses[index + 1].linear() * joints[index].axis;
  JointLoad load;
  for (size_t i = 0; i < links.size(); ++i) {
    if (!carried[i]) continue;
    const Eigen::Vector3d lever = poses[i] * links[i].center_of_mass - pivot;
    const Eigen::Vector3d weight(0.0, 0.0, -kJointGravityLoadGravity * links[i].mass);
    load.mass += links[i].mass;
    if (joints[index].type == UrdfJointType::kPrismatic) {
      load.inertia += links[i].mass;
      load.gravity += weight.dot(axis);
    } else {
      const Eigen::Matrix3d turned =
          poses[i].linear() * links[i].inertia * poses[i].linear().transpose();
      load.inertia += axis.dot(turned * axis) + links[i].mass * lever.cross(axis).squaredNorm();
      load.gravity += lever.cross(weight).dot(axis);
    }
  }
  return load;
}

}  // namespace simwright::assets
