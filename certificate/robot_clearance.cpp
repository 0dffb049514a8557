#include "certificate/robot_clearance.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/articulated_body.h"

namespace simwright::certificate {
namespace {

constexpr double kPathStep = 0.025;  // rad or m of any joint between checks
constexpr double kFloorGap = 0.005;  // m

// Returns the convex shapes of a link: capsules where the URDF has them.
std::vector<geometry::ConvexShape> ShapesOf(const sim::RigidBody& link) {
  std::vector<geometry::ConvexShape> shapes;
  for (size_t i = 0; i < link.parts.size(); ++i) {
    if (i < link.capsules.size() && link.capsules[i]) {
      const sim::Capsule& capsule = *link.capsules[i];
      shapes.push_back({{capsule.a, capsule.b}, capsule.radius});
    } else {
      shapes.push_back({link.parts[i].vertices, 0.0});
    }
  }
  return shapes;
}

}  // namespace

RobotShapes::RobotShapes(const robot::RobotModel& given) : robot(&given) {
  const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(given.urdf, given.kinematics);
  bool any = false;
  for (const sim::RigidBody& link : body.links) {
    links.push_back(ShapesOf(link));
    any = any || !links.back().empty();
  }
  if (!any) throw core::Error("the robot has no collision shapes", given.name);
  const std::vector<int>& parents = body.kinematics->parents();
  const int last = given.arm_joints.back() + 1;  // the child link of the last joint
  std::vector<char> of_gripper(links.size(), 0);
  for (size_t i = 1; i < links.size(); ++i) {
    const auto parent = static_cast<size_t>(parents[i - 1]);
    of_gripper[i] = static_cast<int>(i) == last || of_gripper[parent];
    if (of_gripper[i]) gripper_links.push_back(static_cast<int>(i));
  }
  near_base.assign(links.size(), 0);
  near_base[0] = 1;
  for (size_t i = 1; i < links.size(); ++i) near_base[i] = parents[i - 1] == 0;
  const auto ignored = [&](int a, int b) {
    const auto& pairs = given.ignored_collisions;
    return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return (pair.first == a && pair.second == b) || (pair.first == b && pair.second == a);
    });
  };
  for (int a = 0; a < static_cast<int>(links.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(links.size()); ++b) {
      if (links[static_cast<size_t>(a)].empty() || links[static_cast<size_t>(b)].empty()) continue;
      const bool both = of_gripper[static_cast<size_t>(a)] && of_gripper[static_cast<size_t>(b)];
      if (!both && !ignored(a, b)) self_pairs.emplace_back(a, b);
    }
  }
}

RobotClearance::RobotClearance(const RobotShapes& shapes, const Obstacles& obstacles,
                               const Eigen::Isometry3d& world_from_robot,
                               const ClearanceMargins& margins)
    : shapes_(shapes),
      obstacles_(obstacles),
      world_from_robot_(world_from_robot),
      margins_(margins),
      leader_(shapes.robot->gripper.open),
      placed_(shapes.links.size()) {
  for (size_t i = 0; i < placed_.size(); ++i) placed_[i].resize(shapes.links[i].size());
}

void RobotClearance::Hold(const BodyModel* held, const Eigen::Isometry3d& tool_from_held) {
  held_ = held;
  tool_from_held_ = tool_from_held;
}

void RobotClearance::PlaceLinks(const robot::JointVector& arm) const {
  const std::vector<Eigen::Isometry3d> poses = shapes_.robot->LinkPoses(arm, leader_);
  for (size_t i = 0; i < placed_.size(); ++i) {
    if (placed_[i].empty()) continue;
    const Eigen::Isometry3d pose = world_from_robot_ * poses[i];
    for (size_t k = 0; k < placed_[i].size(); ++k) placed_[i][k].Place(shapes_.links[i][k], pose);
  }
}

int RobotClearance::LinkHit(int link, double margin) const {
  for (const PlacedShape& shape : placed_[static_cast<size_t>(link)]) {
    const int hit = obstacles_.Hit(shape, margin);
    if (hit != kFree) return hit;
    if (floor_ && !shapes_.near_base[static_cast<size_t>(link)] &&
        shape.box.min().z() < kFloorGap) {
      return kHitsFloor;
    }
  }
  return kFree;
}

int RobotClearance::HeldHit(const Eigen::Isometry3d& world_from_tool) const {
  if (held_ == nullptr) return kFree;
  const Eigen::Isometry3d pose = world_from_tool * tool_from_held_;
  for (const geometry::ConvexShape& part : held_->parts) {
    held_shape_.Place(part, pose);
    const int hit = obstacles_.Hit(held_shape_, margins_.held, held_ignores_);
    if (hit != kFree) return hit;
    if (floor_ && held_shape_.box.min().z() < 0.0) return kHitsFloor;
  }
  return kFree;
}

bool RobotClearance::HitsItself() const {
  for (const auto& [a, b] : shapes_.self_pairs) {
    for (const PlacedShape& one : placed_[static_cast<size_t>(a)]) {
      for (const PlacedShape& other : placed_[static_cast<size_t>(b)]) {
        if (!one.box.intersects(other.box)) continue;
        if (!geometry::AreApart(one.shape, other.shape, 0.0)) return true;
      }
    }
  }
  return false;
}

int RobotClearance::Counted(int hit) const {
  if (hit >= 0 && static_cast<size_t>(hit) < hits_.size()) ++hits_[static_cast<size_t>(hit)];
  return hit;
}

int RobotClearance::Hit(const robot::JointVector& arm) const {
  PlaceLinks(arm);
  const std::vector<int>& gripper = shapes_.gripper_links;
  for (int link = static_cast<int>(placed_.size()) - 1; link >= 0; --link) {
    const bool of_gripper = std::find(gripper.begin(), gripper.end(), link) != gripper.end();
    const int hit = LinkHit(link, of_gripper ? margins_.gripper : margins_.arm);
    if (hit != kFree) return Counted(hit);
  }
  if (HitsItself()) return kHitsItself;
  if (held_ == nullptr) return kFree;
  return Counted(HeldHit(world_from_robot_ * robot::ForwardKinematics(shapes_.robot->arm, arm)));
}

int RobotClearance::GripperHit(const Eigen::Isometry3d& world_from_tool) const {
  const std::vector<Eigen::Isometry3d> poses =
      shapes_.robot->LinkPoses(shapes_.robot->home(), leader_);
  const Eigen::Isometry3d world_from_root =
      world_from_tool * poses[static_cast<size_t>(shapes_.robot->tool_link)].inverse();
  for (const int link : shapes_.gripper_links) {
    const auto i = static_cast<size_t>(link);
    for (size_t k = 0; k < placed_[i].size(); ++k) {
      placed_[i][k].Place(shapes_.links[i][k], world_from_root * poses[i]);
    }
    const int hit = LinkHit(link, margins_.gripper);
    if (hit != kFree) return Counted(hit);
  }
  return Counted(HeldHit(world_from_tool));
}

int RobotClearance::PathHit(const robot::JointVector& from, const robot::JointVector& to) const {
  const double length = (to - from).lpNorm<Eigen::Infinity>();
  const int checks = 1 + static_cast<int>(length / kPathStep);
  // The end first, then the middle: most hits are found soon.
  int stride = 1;
  while (stride < checks) stride *= 2;
  for (bool first = true; stride >= 1; first = false, stride /= 2) {
    for (int i = checks; i > 0; i -= stride) {
      const bool done = !first && (checks - i) % (2 * stride) == 0;
      if (done) continue;
      const int hit = Hit(from + (static_cast<double>(i) / checks) * (to - from));
      if (hit != kFree) return hit;
    }
  }
  return kFree;
}

void RobotClearance::MarkNear(const robot::JointVector& arm, double margin,
                              std::vector<char>* near) const {
  PlaceLinks(arm);
  for (const std::vector<PlacedShape>& link : placed_) {
    for (const PlacedShape& shape : link) obstacles_.Mark(shape, margin, near);
  }
  if (held_ == nullptr) return;
  const Eigen::Isometry3d pose =
      world_from_robot_ * robot::ForwardKinematics(shapes_.robot->arm, arm) * tool_from_held_;
  for (const geometry::ConvexShape& part : held_->parts) {
    held_shape_.Place(part, pose);
    obstacles_.Mark(held_shape_, margin, near);
  }
}

}  // namespace simwright::certificate
