#pragma once

#include <utility>
#include <vector>

#include "certificate/clearance_margins.h"
#include "certificate/obstacles.h"
#include "manipulation/path_checker.h"
#include "robot/robot_model.h"

namespace simwright::certificate {

// The collision shapes of a robot by link: capsules and boxes. Constant.
struct RobotShapes {
  // Throws core::Error if the robot has no collision shapes.
  explicit RobotShapes(const robot::RobotModel& robot);

  const robot::RobotModel* robot;
  std::vector<std::vector<geometry::ConvexShape>> links;  // (urdf.links) link frames
  std::vector<int> gripper_links;                         // all from the arm's last joint on
  std::vector<std::pair<int, int>> self_pairs;            // links that may not touch each other
  std::vector<char> near_base;                            // links that the floor is not checked for
};

// Results of a check other than the index of a scene's body.
inline constexpr int kFree = -1, kHitsFloor = -2, kHitsItself = -3;

// Collision checks of a robot at a base, with or without a held object, against obstacles. Counts
// the hits by body. Not thread-safe.
class RobotClearance : public manipulation::PathChecker {
 public:
  // All arguments must outlive this.
  RobotClearance(const RobotShapes& shapes, const Obstacles& obstacles,
                 const Eigen::Isometry3d& world_from_robot, const ClearanceMargins& margins);

  // Sets the position of the gripper's first joint for the following checks.
  void SetLeader(double leader) { leader_ = leader; }
  void IgnoreFloor() { floor_ = false; }
  // Attaches a body to the tool; null: none.
  void Hold(const BodyModel* held, const Eigen::Isometry3d& tool_from_held);

  // Ignores flagged bodies for the held object (null: none), such as what it touches at first.
  void IgnoreForHeld(const std::vector<char>* bodies) { held_ignores_ = bodies; }

  // Returns the body that the robot or its held object hits, kHitsFloor, kHitsItself, or kFree.
  int Hit(const robot::JointVector& arm) const;
  // Returns the same for the gripper and the held object alone, with the tool at a pose.
  int GripperHit(const Eigen::Isometry3d& world_from_tool) const;
  // Returns the first hit along the straight joint-space segment, its start excluded.
  int PathHit(const robot::JointVector& from, const robot::JointVector& to) const;
  // Sets the flag of each body within `margin` (m) of the robot or the held object.
  void MarkNear(const robot::JointVector& arm, double margin, std::vector<char>* near) const;

  bool IsConfigurationFree(const robot::JointVector& arm) const override {
    return Hit(arm) == kFree;
  }
  bool IsPathCollisionFree(const robot::JointVector& from,
                           const robot::JointVector& to) const override {
    return PathHit(from, to) == kFree;
  }

  // The number of hits of each body so far.
  const std::vector<int>& hits() const { return hits_; }
  void CountHits(size_t bodies) { hits_.assign(bodies, 0); }

 private:
  void PlaceLinks(const robot::JointVector& arm) const;
  int LinkHit(int link, double margin) const;
  int HeldHit(const Eigen::Isometry3d& world_from_tool) const;
  bool HitsItself() const;
  int Counted(int hit) const;

  const RobotShapes& shapes_;
  const Obstacles& obstacles_;
  Eigen::Isometry3d world_from_robot_;
  ClearanceMargins margins_;
  double leader_ = 0.0;
  bool floor_ = true;
  const BodyModel* held_ = nullptr;
  const std::vector<char>* held_ignores_ = nullptr;
  Eigen::Isometry3d tool_from_held_ = Eigen::Isometry3d::Identity();
  mutable std::vector<std::vector<PlacedShape>> placed_;  // by link
  mutable PlacedShape held_shape_;
  mutable std::vector<int> hits_;
};

}  // namespace simwright::certificate
