#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "assets/joint_load.h"
#include "assets/urdf_reader.h"
#include "sim/rigid_body.h"

namespace simwright::sim {

// What a physics engine needs of a jointed thing. Constant; shared by any number of worlds.
struct ArticulatedBody {
  std::string name;
  std::vector<RigidBody> links;           // the root first, each in its own frame
  std::vector<assets::UrdfJoint> joints;  // joints[i] leads to links[i + 1]
  std::vector<int> parents;               // link that joints[i] hangs on
  // Links, the lesser index first, that make no contact with each other.
  std::set<std::pair<int, int>> excluded_pairs = {};

  // Joints that move, as indices into `joints`, in order.
  std::vector<int> MovingJoints() const;
  // Index of a joint or link by name. Throws core::Error for an unknown one.
  int JointIndex(const std::string& joint) const;
  int LinkIndex(const std::string& link) const;
};

// Any URDF whose moving links have inertials; collision meshes are taken as convex. A link without
// an inertial is allowed as the root of a fixed body, and on a fixed joint (a tool's frame).
// Throws core::Error, naming the link, where a moving one has none, and for floating or planar
// joints.
ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model);

// A single rigid body, as one without joints.
ArticulatedBody ArticulatedBodyFrom(const RigidBody& body);

// assets::LoadOn for a body that stands upright.
assets::JointLoad LoadOn(const ArticulatedBody& body, int joint, double position);

}  // namespace simwright::sim
