#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/mesh.h"
#include "geometry/distance.h"
#include "manipulation/grasp.h"
#include "sim/articulated_world.h"
#include "sim/rigid_body.h"

namespace simwright::certificate {

// A rigid body in its forms for planning and physics. Constant; shared by scenes and threads.
struct BodyModel {
  // Throws core::Error for a body without parts.
  explicit BodyModel(const sim::RigidBody& body, std::vector<manipulation::Grasp> grasps = {});

  std::vector<core::TriangleMesh> meshes;    // convex parts, body frame
  std::vector<geometry::ConvexShape> parts;  // the same
  Eigen::AlignedBox3d box;                   // of the parts, body frame
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();
  double friction = 0.5;
  double radius = 0.0;  // m, the largest distance of a vertex from the centre of mass
  std::shared_ptr<const sim::PreparedBody> physics;
  // Grasps that were proved for the robot's gripper (manipulation::ProveGrasps), body frame. Empty:
  // the planner samples grasps.
  std::vector<manipulation::Grasp> grasps;
};

struct PlacedBody {
  std::string name;  // "apple_2_0", unique in its scene
  std::shared_ptr<const BodyModel> model;
  Eigen::Isometry3d world_from_body = Eigen::Isometry3d::Identity();
  bool fixed = false;  // furniture
};

// The bodies of a scene above the floor z = 0.
struct PlacedScene {
  std::vector<PlacedBody> bodies;

  // Returns the scene without some bodies, by index.
  PlacedScene Without(const std::vector<int>& removed) const;
  int Find(const std::string& name) const;  // -1: none
};

// Returns the AABB of a body in the world frame, m.
Eigen::AlignedBox3d BoundsOf(const BodyModel& model, const Eigen::Isometry3d& world_from_body);
Eigen::AlignedBox3d BoundsOf(const PlacedBody& body);

// Returns the fixed body that supports `body`: the one with the highest point below the middle of
// the body's box; -1 if there is none, such as on the floor.
int SupportOf(const PlacedScene& scene, int body);

}  // namespace simwright::certificate
