#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "assets/joint_gravity_load.h"
#include "assets/urdf_reader.h"
#include "sim/rigid_body.h"

namespace simwright::sim {

// The description of an articulated body for a physics engine. Constant; shared by any number of
// worlds.
struct ArticulatedBody {
  std::string name;
  std::vector<RigidBody> links;           // the root first, each in its own frame
  std::vector<assets::UrdfJoint> joints;  // joints[i] leads to links[i + 1]
  std::vector<int> parents;               // parent link of joints[i]
  // Pairs of links, the lesser index first, that do not collide with each other.
  std::set<std::pair<int, int>> excluded_pairs = {};

  // Returns the movable joints as indices into `joints`, in order.
  std::vector<int> MovingJoints() const;
  // Returns the index of a joint or link by name. Throws core::Error for an unknown one.
  int JointIndex(const std::string& joint) const;
  int LinkIndex(const std::string& link) const;
};

// Converts any URDF whose moving links have inertials; collision meshes are taken as convex. A link
// may lack an inertial as the root of a fixed body and on a fixed joint (a tool frame). Throws
// core::Error, naming the link, for a moving link without an inertial, and for floating or planar
// joints.
ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model);

// Converts a single rigid body to an articulated body without joints.
ArticulatedBody ArticulatedBodyFrom(const RigidBody& body);

// Returns assets::LoadOn for a body that stands upright.
assets::JointLoad LoadOn(const ArticulatedBody& body, int joint, double position);

}  // namespace simwright::sim
