#include "manipulation/interaction_target.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "manipulation/push_contact.h"
#include "manipulation/top_receptacle.h"

namespace simwright::manipulation {
namespace {

using Eigen::Vector3d;
using reward::RewardInput;
using reward::RewardSlot;
using tasks::ArticulatedObject;
using tasks::WorldModel;
using tasks::WorldState;

constexpr double kFingerDepth = 0.02;  // m from the fingertips to the palm, less a margin
// The largest depth (m) of the fingertips' middle below a handle's outermost point: at this depth
// the pads close behind a bar of 1 to 2 cm and hook it, while at 0.8 cm they only rub on it.
constexpr double kPadDepth = 0.02;
constexpr double kPushHeight = 0.35;       // share of an object's height
constexpr double kLowestPush = 0.025;      // m above the floor: fingertips have some thickness
constexpr double kSpare = 0.01;            // m that the gripper opens wider than its target
constexpr double kGraspFromBelow = 0.5;    // of a direction's rise: more comes from below
constexpr double kWidthTolerance = 0.002;  // m: widths that count as equal
constexpr double kHalfWall = 0.003;        // m: cup walls are 3 to 8 mm thick

bool IsPlace(RewardInput input) {
  return input == RewardInput::kLinkPosition || input == RewardInput::kAssetPosition ||
         input == RewardInput::kLinkBoundingBox || input == RewardInput::kAssetBoundingBox;
}

const RewardSlot* FirstSlot(const std::vector<RewardSlot>& slots, bool (*wanted)(RewardInput)) {
  for (const RewardSlot& slot : slots) {
    if (wanted(slot.input) && !slot.asset.empty()) return &slot;
  }
  return nullptr;
}

// Returns the direction (unit, world) in which the joint moves `point` (world); zero if it only
// rotates it.
Vector3d Tangent(const tasks::ObjectJoint& joint, const Eigen::Isometry3d& world_from_link,
                 const Vector3d& point) {
  const Vector3d axis = world_from_link.linear() * joint.axis;
  if (joint.type == reward::RewardJointType::kPrismatic) return axis;
  const Vector3d arm = point - world_from_link.translation();
  const Vector3d tangent = axis.cross(arm);
  return tangent.norm() > 0.02 ? tangent.normalized() : Vector3d::Zero();
}

// Returns the side of the object on which the point lies, along `line`: +1 or -1.
double Outward(const Eigen::AlignedBox3d& box, const Vector3d& point, const Vector3d& line) {
  return (point - box.center()).dot(line) >= 0.0 ? 1.0 : -1.0;
}

// Returns the width (m) of the link's hull points along `across` (unit, link frame).
double OutlineWidth(const tasks::ObjectLink& link, const Vector3d& across) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3d& point : link.extreme_points) {
    low = std::min(low, point.dot(across));
    high = std::max(high, point.dot(across));
  }
  return high - low;
}

// Returns the direction, perpendicular to `approach`, along which the link is thinnest. Among
// directions within 2 mm of that, as of round knobs, returns the one nearest to `wished`.
Vector3d ThinAcross(const tasks::ObjectLink& link, const Vector3d& approach,
                    const Vector3d& wished) {
  constexpr int kDirections = 36;
  const Vector3d first = approach.unitOrthogonal(), second = approach.cross(first);
  Vector3d directions[kDirections];
  double widths[kDirections];
  double thinnest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    directions[i] = std::cos(angle) * first + std::sin(angle) * second;
    widths[i] = OutlineWidth(link, directions[i]);
    thinnest = std::min(thinnest, widths[i]);
  }
  Vector3d best = first;
  double nearest = -1.0;
  for (int i = 0; i < kDirections; ++i) {
    const double along = std::abs(directions[i].dot(wished));
    if (widths[i] > thinnest + kWidthTolerance || along <= nearest) continue;
    nearest = along;
    best = directions[i];
  }
  return best;
}

// Returns the grasp point of a part that is approached along `approach`: the middle of its hull
// points, but at most kPadDepth below its outermost point.
Vector3d GripPoint(const tasks::ObjectLink& link, const Vector3d& approach) {
  double outermost = std::numeric_limits<double>::infinity();
  for (const Vector3d& point : link.extreme_points) {
    outermost = std::min(outermost, approach.dot(point - link.middle));
  }
  const double deeper = std::min(0.0, outermost + kPadDepth);
  return link.middle + deeper * approach;
}

Eigen::Isometry3d ToolAcross(const tasks::ObjectLink& link, const Vector3d& approach,
                             const Vector3d& across) {
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
  tool.linear() << across.cross(approach), across, approach;
  tool.translation() = GripPoint(link, approach);
  return tool;
}

// Returns the directions (unit, world) of approach to a part, the most natural first: from outside
// along the part's direction of motion, or along the axis of a part that rotates in place; from
// above; from the side of the object that the part is on, first steep, where the arm has room over
// the floor, then level. Never from below, since objects stand on a support.
std::vector<Vector3d> ApproachDirections(const Eigen::AlignedBox3d& box, const Vector3d& point,
                                         const Vector3d& motion, const Vector3d& axis) {
  std::vector<Vector3d> directions;
  const auto add = [&](const Vector3d& direction) {
    if (direction.z() < kGraspFromBelow) directions.push_back(direction);
  };
  const Vector3d line = motion.isZero() ? axis : motion;
  const Vector3d outward = Outward(box, point, line) * line;
  add(-outward);
  if (motion.isZero() || -outward.z() >= kGraspFromBelow) add(outward);
  add(-Vector3d::UnitZ());
  Vector3d aside = (point - box.center()).cwiseQuotient(box.sizes());
  aside.z() = 0.0;
  Eigen::Index face = 0;
  if (aside.cwiseAbs().maxCoeff(&face) > 0.0) {
    const Vector3d inward = std::copysign(1.0, -aside[face]) * Vector3d::Unit(face);
    for (const double down : {2.0, 1.0, 0.5, 0.0}) {
      if (motion.isZero() && down > 0.0) continue;  // it rotates the gripper about itself
      add((inward - down * Vector3d::UnitZ()).normalized());
    }
  }
  return directions;
}

// Returns the grasp poses at a part that a joint moves, in the link's frame: for each direction
// with the closing axis across the thin side, and across the other side if the gripper spans it.
std::vector<Eigen::Isometry3d> ToolsOnPart(const WorldModel& model, const WorldState& start,
                                           const InteractionTarget& target, double opening) {
  const ArticulatedObject& object = model.objects[static_cast<size_t>(target.object)];
  const tasks::ObjectJoint& joint = object.joints[static_cast<size_t>(target.joint)];
  WorldState rest = start;
  rest.joints[static_cast<size_t>(target.object)] = tasks::RestPositions(object);
  const std::vector<Eigen::Isometry3d> poses =
      tasks::LinkPosesOf(object, rest.joints[static_cast<size_t>(target.object)]);
  const Eigen::Isometry3d& root = rest.roots[static_cast<size_t>(target.object)];
  const Eigen::Isometry3d world_from_link = root * poses[static_cast<size_t>(target.link)];
  const Eigen::Isometry3d world_from_moved = root * poses[static_cast<size_t>(joint.link)];
  const tasks::ObjectLink& link = object.links[static_cast<size_t>(target.link)];
  const Vector3d point = world_from_link * link.middle;
  const std::vector<Vector3d> directions = ApproachDirections(
      tasks::WorldAabb(model, rest, target.object), point, Tangent(joint, world_from_moved, point),
      world_from_moved.linear() * joint.axis);
  std::vector<Eigen::Isometry3d> tools;
  for (const Vector3d& direction : directions) {
    const Vector3d approach = world_from_link.linear().transpose() * direction;
    // A horizontal closing axis is preferred: grippers are wide along it, and parts are stacked
    // vertically.
    const Vector3d level = direction.cross(Vector3d::UnitZ());
    const Vector3d thin = ThinAcross(link, approach, world_from_link.linear().transpose() * level);
    tools.push_back(ToolAcross(link, approach, thin));
    const Vector3d other = approach.cross(thin);
    if (OutlineWidth(link, other) < opening - kSpare) {
      tools.push_back(ToolAcross(link, approach, other));
    }
  }
  return tools;
}

// Returns the grasp point of an object that is grasped from above: its middle, but at most the
// palm's depth below its top.
Vector3d GraspPoint(const ArticulatedObject& object) {
  Vector3d point = object.box.center();
  point.z() = std::max(point.z(), object.box.max().z() - kFingerDepth);
  return point;
}

// Returns the pushing point of an object: below its middle, so that it slides and does not tip.
Vector3d PushPoint(const ArticulatedObject& object) {
  Vector3d point = object.box.center();
  const double above = std::max(kLowestPush, kPushHeight * object.height());
  point.z() = std::min(object.box.min().z() + above, GraspPoint(object).z());
  return point;
}

// Returns the distance from the middle to the wall of a vessel that is too wide for the gripper,
// else 0.
double RimOf(const ArticulatedObject& object, const Eigen::Isometry3d& world_from_object,
             double opening) {
  const bool vessel = std::any_of(object.receptacles.begin(), object.receptacles.end(),
                                  [](const tasks::Receptacle& receptacle) {
                                    return receptacle.link == 0 && receptacle.door < 0 &&
                                           receptacle.opening.z() > 0.9;
                                  });
  const double yaw = ThinDirection(object, world_from_object, 0.0);
  const double width = WidthAlong(object, world_from_object, {std::cos(yaw), std::sin(yaw), 0.0});
  return vessel && width > opening - kSpare ? 0.5 * width - kHalfWall : 0.0;
}

}  // namespace

std::optional<InteractionTarget> FindInteractionTarget(const WorldModel& model,
                                                       const WorldState& start,
                                                       const std::vector<RewardSlot>& slots,
                                                       double opening, double base) {
  const auto of_joint = [](RewardInput input) { return input == RewardInput::kJointState; };
  const auto of_grasp = [](RewardInput input) { return input == RewardInput::kGrasped; };
  InteractionTarget target;
  if (const RewardSlot* slot = FirstSlot(slots, of_joint)) {
    target.object = model.Find(slot->asset);
    const ArticulatedObject& object = model.objects[static_cast<size_t>(target.object)];
    target.joint = object.FindJoint(slot->part);
    if (target.joint >= 0) {
      const tasks::ObjectJoint& joint = object.joints[static_cast<size_t>(target.joint)];
      const auto t = static_cast<size_t>(target.object), j = static_cast<size_t>(target.joint);
      target.pushes = IsClosedByPushing(object, joint, start.joints[t][j]);
      target.link = target.pushes ? joint.link : joint.grasp_link;
      target.approaches = target.pushes ? PushingPoses(model, start, target.object, joint, base)
                                        : ToolsOnPart(model, start, target, opening);
      target.link_from_grasp = target.approaches.front();
      return target;
    }
  }
  const RewardSlot* slot = FirstSlot(slots, of_grasp);
  const bool grasps = slot != nullptr;
  if (!grasps) slot = FirstSlot(slots, IsPlace);
  if (slot == nullptr) return std::nullopt;
  target.object = model.Find(slot->asset);
  target.link = 0;
  if (grasps) {
    target.rim = RimOf(model.objects[static_cast<size_t>(target.object)],
                       start.roots[static_cast<size_t>(target.object)], opening);
  }
  const ArticulatedObject& object = model.objects[static_cast<size_t>(target.object)];
  target.link_from_grasp.translation() = grasps ? GraspPoint(object) : PushPoint(object);
  return target;
}

std::optional<Destination> DestinationOf(const WorldModel& model, const WorldState& start,
                                         const InteractionTarget& target,
                                         const std::vector<RewardSlot>& slots) {
  Destination destination;
  for (const RewardSlot& slot : slots) {
    if (slot.input == RewardInput::kGoalPosition) {
      destination.goal = true;
      return destination;
    }
  }
  if (target.joint >= 0) return std::nullopt;
  for (const RewardSlot& slot : slots) {
    const int object = slot.asset.empty() ? -1 : model.Find(slot.asset);
    if (!IsPlace(slot.input) || object < 0 || object == target.object) continue;
    const ArticulatedObject& holder = model.objects[static_cast<size_t>(object)];
    destination.object = object;
    destination.link = slot.part.empty() ? 0 : holder.FindLink(slot.part);
    const Eigen::AlignedBox3d& box = holder.links[static_cast<size_t>(destination.link)].box;
    destination.point = {box.center().x(), box.center().y(), box.max().z()};
    for (const tasks::Receptacle& receptacle : holder.receptacles) {
      if (receptacle.link != destination.link) continue;
      destination.in_top_opening = OpensUpwards(model, start, object, receptacle);
      destination.point = destination.in_top_opening
                              ? PlacementFromAbove(model, start, object, receptacle)
                              : Vector3d(receptacle.box.center());
      break;
    }
    destination.room = FindSideReceptacle(model, start, object, destination.link);
    if (destination.room) {
      destination.point = PlacementBehindOpening(
          *destination.room, model, start, tasks::WorldAabb(model, start, target.object).sizes());
    }
    return destination;
  }
  return std::nullopt;
}

Eigen::Isometry3d GraspPoseAtJoint(const WorldModel& model, const WorldState& state,
                                   const InteractionTarget& target) {
  const auto object = static_cast<size_t>(target.object);
  const std::vector<Eigen::Isometry3d> poses =
      tasks::LinkPosesOf(model.objects[object], state.joints[object]);
  return state.roots[object] * poses[static_cast<size_t>(target.link)] * target.link_from_grasp;
}

double WidthAlong(const ArticulatedObject& object, const Eigen::Isometry3d& world_from_object,
                  const Vector3d& across) {
  const Vector3d local = world_from_object.linear().transpose() * across;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const tasks::ObjectLink& link : object.links) {
    for (const Vector3d& point : link.extreme_points) {
      low = std::min(low, point.dot(local));
      high = std::max(high, point.dot(local));
    }
  }
  return high - low;
}

double ThinDirection(const ArticulatedObject& object, const Eigen::Isometry3d& world_from_object,
                     double wished) {
  constexpr int kDirections = 36;
  double widths[kDirections];
  double thinnest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    widths[i] = WidthAlong(object, world_from_object, {std::cos(angle), std::sin(angle), 0.0});
    thinnest = std::min(thinnest, widths[i]);
  }
  double best = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    if (widths[i] > thinnest + kWidthTolerance) continue;
    // Both senses of a direction are one: the difference lies in [-pi/2, pi/2].
    const double off =
        std::remainder(std::numbers::pi * i / kDirections - wished, std::numbers::pi);
    if (std::abs(off) >= nearest) continue;
    nearest = std::abs(off);
    best = wished + off;
  }
  return best;
}

}  // namespace simwright::manipulation
