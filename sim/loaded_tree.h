#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "sim/bullet_shape.h"
#include "sim/joint_velocity_constraint.h"
#include "sim/link_tree.h"
#include "sim/tree_dynamics.h"

class btMultiBody;
class btMultiBodyGearConstraint;
class btMultiBodyJointLimitConstraint;
class btMultiBodyLinkCollider;

namespace simwright::sim {

class PreparedBody;

// A joint of a body in a world.
struct LoadedJoint {
  bool moves = false;
  double friction = 0.0;
  JointMotor motor;  // with friction and damping
  // N m or N at most, of a mimic joint.
  double gear_force = std::numeric_limits<float>::max();
  // The constraints for Bullet's own solver.
  std::unique_ptr<JointVelocityConstraint> motor_constraint;
  std::unique_ptr<btMultiBodyJointLimitConstraint> limit;
  std::unique_ptr<btMultiBodyGearConstraint> gear;  // to the leader of a mimic joint
};

// A body in a world: its tree in Bullet, with a collider for each link that has a shape or carries
// others.
class LoadedTree {
 public:
  LoadedTree();
  ~LoadedTree();
  LoadedTree(const LoadedTree&) = delete;
  LoadedTree& operator=(const LoadedTree&) = delete;

  std::shared_ptr<const PreparedBody> prepared;
  const LinkTree* tree = nullptr;
  const std::vector<std::unique_ptr<BulletShape>>* shapes_by_link = nullptr;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;
  std::vector<LoadedJoint> joints;
  std::unique_ptr<btMultiBody> multi;
  std::unique_ptr<TreeDynamics> dynamics;  // for CompactSolver

  const BulletShape& Shape(int link) const {
    return *shapes_by_link->at(static_cast<size_t>(link));
  }
  btMultiBodyLinkCollider* Collider(int link) const {
    return colliders.at(static_cast<size_t>(link)).get();
  }
  // Returns Bullet's index of the child link of joint `joint`.
  int Joint(int joint) const { return tree->links.at(static_cast<size_t>(joint) + 1).bullet; }

  // Prepares PlaceColliders, once all colliders are there.
  void AddOffsets();
  // Moves all colliders to the poses of `dynamics`; returns false if these have not changed.
  bool FollowDynamics();
  // Moves the colliders with an offset, after Bullet has moved each to its link's frame.
  void PlaceColliders();

 private:
  struct Offset;
  std::vector<Offset> offsets_;  // a carrier's own collider after those of its links
};

}  // namespace simwright::sim
