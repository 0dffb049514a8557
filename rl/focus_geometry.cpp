#include "rl/focus_geometry.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kOnAxis = 1e-3;  // m: a nearer part rotates in place

void Extend(const tasks::ThingLink& link, const Isometry3d& frame_from_link,
            Eigen::AlignedBox3d* box) {
  for (const Vector3d& point : link.outline) box->extend(frame_from_link * point);
}

// Adds the motion of the frame's origin with the joint. `frame_from_moved`: the pose of the link
// that the joint moves, whose origin is on its axis.
void AddJoint(const tasks::ThingJoint& joint, const Isometry3d& frame_from_moved,
              FocusGeometry* geometry) {
  const Vector3d axis = frame_from_moved.linear() * joint.axis;
  if (joint.type == tasks::RewardJointType::kPrismatic) {
    geometry->way = axis;
    return;
  }
  const Vector3d to_joint = frame_from_moved.translation();
  geometry->hinge = to_joint - axis.dot(to_joint) * axis;
  if (geometry->hinge.norm() > kOnAxis) {
    geometry->way = axis.cross(-geometry->hinge).normalized();
  }
}

}  // namespace

FocusGeometry GeometryOf(const tasks::SceneModel& model, const tasks::SceneState& state,
                         const Focus& focus, const Isometry3d& world_from_frame) {
  const auto index = static_cast<size_t>(focus.thing);
  const tasks::Thing& thing = model.things[index];
  const std::vector<Isometry3d> poses = tasks::LinkPosesOf(thing, state.joints[index]);
  const Isometry3d frame_from_root = world_from_frame.inverse() * state.roots[index];
  FocusGeometry geometry;
  Eigen::AlignedBox3d box;
  for (size_t l = 0; l < thing.links.size(); ++l) {
    if (focus.joint >= 0 && static_cast<int>(l) != focus.link) continue;
    Extend(thing.links[l], frame_from_root * poses[l], &box);
  }
  if (!box.isEmpty()) {
    geometry.size = box.sizes();
    geometry.middle = box.center();
  }
  if (focus.joint >= 0) {
    const tasks::ThingJoint& joint = thing.joints[static_cast<size_t>(focus.joint)];
    AddJoint(joint, frame_from_root * poses[static_cast<size_t>(joint.link)], &geometry);
  }
  return geometry;
}

}  // namespace simwright::rl
