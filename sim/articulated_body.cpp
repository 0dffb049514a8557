#include "sim/articulated_body.h"

#include <algorithm>

#include "assets/joint_poses.h"
#include "core/error.h"

namespace simwright::sim {
namespace {

constexpr double kGravity = 9.81;  // m/s^2

template <typename Items>
int IndexByName(const Items& items, const std::string& name, const std::string& body,
                const char* what) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
  if (found == items.end()) throw core::Error(std::string("has no such ") + what, body, name);
  return static_cast<int>(found - items.begin());
}

}  // namespace

std::vector<int> ArticulatedBody::MovingJoints() const {
  std::vector<int> moving;
  for (size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].Moves()) moving.push_back(static_cast<int>(i));
  }
  return moving;
}

int ArticulatedBody::JointIndex(const std::string& joint) const {
  return IndexByName(joints, joint, name, "joint");
}

int ArticulatedBody::LinkIndex(const std::string& link) const {
  return IndexByName(links, link, name, "link");
}

ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model) {
  ArticulatedBody body;
  body.name = model.name;
  body.joints = model.joints;
  body.parents = assets::ParentLinks(model);
  for (size_t i = 0; i < model.links.size(); ++i) {
    const assets::UrdfLink& link = model.links[i];
    RigidBody& copy = body.links.emplace_back();
    copy.name = link.name;
    copy.friction = link.friction;
    copy.restitution = link.restitution;
    copy.rolling_friction = link.rolling_friction;
    for (const assets::UrdfShape& shape : link.collisions) copy.parts.push_back(shape.mesh);
    if (link.inertial) {
      copy.inertial = *link.inertial;
    } else if (i > 0 && model.joints[i - 1].Moves()) {
      throw core::Error("a link that moves has no inertial",
                        model.name + " link '" + link.name + "'", "add an <inertial> element");
    }
    if (i == 0) continue;
    const assets::UrdfJointType type = model.joints[i - 1].type;
    if (type == assets::UrdfJointType::kFloating || type == assets::UrdfJointType::kPlanar) {
      throw core::Error("floating and planar joints are not simulated",
                        model.name + " joint '" + model.joints[i - 1].name + "'",
                        "use a tree of revolute, continuous, prismatic and fixed ones");
    }
  }
  return body;
}

ArticulatedBody ArticulatedBodyFrom(const RigidBody& body) {
  ArticulatedBody single;
  single.name = body.name;
  single.links = {body};
  return single;
}

JointLoad LoadOn(const ArticulatedBody& body, int joint, double position,
                 const Eigen::Isometry3d& world_from_root) {
  std::vector<Eigen::Isometry3d> poses(body.links.size(), world_from_root);
  std::vector<bool> carried(body.links.size(), false);
  JointLoad load;
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();
  const bool slides =
      body.joints.at(static_cast<size_t>(joint)).type == assets::UrdfJointType::kPrismatic;
  for (size_t i = 0; i < body.joints.size(); ++i) {
    const size_t parent = static_cast<size_t>(body.parents[i]);
    const bool self = static_cast<int>(i) == joint;
    poses[i + 1] = poses[parent] * body.joints[i].parent_from_joint *
                   assets::JointMotion(body.joints[i], self ? position : 0.0);
    carried[i + 1] = self || carried[parent];
    if (self) {
      pivot = poses[i + 1].translation();
      axis = poses[i + 1].linear() * body.joints[i].axis;
    }
  }
  for (size_t i = 0; i < body.links.size(); ++i) {
    if (!carried[i]) continue;
    const assets::Inertial& inertial = body.links[i].inertial;
    const Eigen::Vector3d lever = poses[i] * inertial.center_of_mass - pivot;
    const Eigen::Vector3d weight(0.0, 0.0, -kGravity * inertial.mass);
    load.mass += inertial.mass;
    if (slides) {
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

}  // namespace simwright::sim
