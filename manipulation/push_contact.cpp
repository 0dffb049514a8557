#include "manipulation/push_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "manipulation/joint_target.h"
#include "manipulation/link_pose.h"

namespace simwright::manipulation {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kSwings = 0.08;      // m, smallest distance of a free edge from its axis
constexpr double kOverEdge = 0.03;    // m from an edge of the face to the fingertips' middle
constexpr double kBehindFace = 0.02;  // m: half of a finger, and a margin
constexpr double kOut = 0.75;         // of the distance from the axis to the free edge
constexpr double kUprightAxis = 0.9;  // cosine of a vertical axis
// The heights (m) above the robot's base up to which an edge is pushed from above, since the arm is
// stretched out at a higher one, and at which a face that extends higher is pushed.
constexpr double kHighest = 0.45, kPushesAt = 0.4;

// A swinging part, about the origin of its link's frame.
struct Swing {
  Vector3d axis;                  // unit
  Vector3d out;                   // unit, from the axis to the free edge
  Vector3d motion_direction;      // unit, direction of motion as the part is shut
  double edge = 0.0, face = 0.0;  // m along out and way
  double low = 0.0, high = 0.0;   // m along the axis
};

Swing SwingOf(const tasks::ArticulatedObject& object, const tasks::ObjectJoint& joint,
              double position) {
  const tasks::ObjectLink& link = object.links[static_cast<size_t>(joint.link)];
  Swing swing;
  swing.axis = joint.axis;
  swing.out = link.middle - link.middle.dot(joint.axis) * joint.axis;
  if (swing.out.norm() < 1e-6) return swing;
  swing.out.normalize();
  swing.motion_direction = (joint.rest() < position ? -1.0 : 1.0) * swing.axis.cross(swing.out);
  swing.face = swing.low = std::numeric_limits<double>::infinity();
  swing.high = -swing.low;
  for (const Vector3d& point : link.extreme_points) {
    swing.edge = std::max(swing.edge, point.dot(swing.out));
    swing.face = std::min(swing.face, point.dot(swing.motion_direction));
    swing.low = std::min(swing.low, point.dot(swing.axis));
    swing.high = std::max(swing.high, point.dot(swing.axis));
  }
  return swing;
}

// Returns the tool pose with its axes along `x` and `z`, at the point `out`, `forward` and `along`
// the axis.
Isometry3d ToolAt(const Swing& swing, const Vector3d& x, const Vector3d& z, double out,
                  double forward, double along) {
  Isometry3d tool = Isometry3d::Identity();
  tool.linear() << x, z.cross(x), z;
  tool.translation() = out * swing.out + forward * swing.motion_direction + along * swing.axis;
  return tool;
}

}  // namespace

bool IsClosedByPushing(const tasks::ArticulatedObject& object, const tasks::ObjectJoint& joint,
                       double position) {
  if (joint.type == reward::RewardJointType::kPrismatic) return false;
  return JointTarget(joint, position) == joint.rest() &&
         SwingOf(object, joint, position).edge > kSwings;
}

std::vector<Isometry3d> PushingPoses(const tasks::WorldModel& model, const tasks::WorldState& start,
                                     int object, const tasks::ObjectJoint& joint, double base) {
  const tasks::ArticulatedObject& whole = model.objects[static_cast<size_t>(object)];
  const auto j = static_cast<size_t>(&joint - whole.joints.data());
  const Swing swing = SwingOf(whole, joint, start.joints[static_cast<size_t>(object)][j]);
  const Vector3d up =
      WorldFromLink(model, start, object, joint.link).linear().transpose() * Vector3d::UnitZ();
  const double rise = up.dot(swing.axis), behind = swing.face - kBehindFace;
  double along = 0.5 * (swing.low + swing.high);
  std::vector<Isometry3d> tools;
  if (std::abs(rise) > kUprightAxis) {
    const double top = rise > 0.0 ? swing.high : swing.low, over = rise > 0.0 ? 1.0 : -1.0;
    const double hinge = WorldFromLink(model, start, object, joint.link).translation().z() - base;
    if (hinge + over * top < kHighest) {
      tools.push_back(ToolAt(swing, swing.motion_direction, -over * swing.axis, kOut * swing.edge,
                             behind, top - over * kOverEdge));
    }
    const double excess = hinge + over * along - kPushesAt;
    if (excess > 0.0) along -= over * excess;
    along = std::clamp(along, swing.low, swing.high);
  }
  tools.push_back(
      ToolAt(swing, swing.motion_direction, -swing.out, swing.edge - kOverEdge, behind, along));
  tools.push_back(
      ToolAt(swing, swing.out, swing.motion_direction, kOut * swing.edge, swing.face, along));
  return tools;
}

}  // namespace simwright::manipulation
