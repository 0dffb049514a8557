#include "manipulation/target_geometry.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kOnAxis = 1e-3;  // m: a nearer part rotates in place

void TargetGeometryExtend(const tasks::ObjectLink& link, const Isometry3d& frame_from_link,
                          Eigen::AlignedBox3d* box) {
  for (const Vector3d& point : link.extreme_points) box->extend(frame_from_link * point);
}

// Adds the motion of the frame's origin with the joint. `frame_from_moved`: the pose of the link
// that the joint moves, whose origin is on its axis.
void AddJoint(const tasks::ObjectJoint& joint, const Isometry3d& frame_from_moved,
              TargetGeometry* geometry) {
  const Vector3d axis = frame_from_moved.linear() * joint.axis;
  if (joint.type == reward::RewardJointType::kPrismatic) {
    geometry->motion_direction = axis;
    return;
  }
  const Vector3d to_joint = frame_from_moved.translation();
  geometry->hinge = to_joint - axis.dot(to_joint) * axis;
  if (geometry->hinge.norm() > kOnAxis) {
    geometry->motion_direction = axis.cross(-geometry->hinge).normalized();
  }
}

}  // namespace

TargetGeometry GeometryOf(const tasks::WorldModel& model, const tasks::WorldState& state,
                          const InteractionTarget& target, const Isometry3d& world_from_frame) {
  const auto index = static_cast<size_t>(target.object);
  const tasks::ArticulatedObject& object = model.objects[index];
  const std::vector<Isometry3d> poses = tasks::LinkPosesOf(object, state.joints[index]);
  const Isometry3d frame_from_root = world_from_frame.inverse() * state.roots[index];
  TargetGeometry geometry;
  Eigen::AlignedBox3d box;
  for (size_t l = 0; l < object.links.size(); ++l) {
    if (target.joint >= 0 && static_cast<int>(l) != target.link) continue;
    TargetGeometryExtend(object.links[l], frame_from_root * poses[l], &box);
  }
  if (!box.isEmpty()) {
    geometry.size = box.sizes();
    geometry.middle = box.center();
  }
  if (target.joint >= 0) {
    const tasks::ObjectJoint& joint = object.joints[static_cast<size_t>(target.joint)];
    AddJoint(joint, frame_from_root * poses[static_cast<size_t>(joint.link)], &geometry);
  }
  return geometry;
}

}  // namespace simwright::manipulation
