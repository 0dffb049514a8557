#pragma once

#include <memory>
#include <string>
#include <vector>

#include "assets/kinematic_model.h"
#include "assets/urdf_reader.h"
#include "sim/rigid_body.h"

namespace simwright::sim {

// An articulated body for a physics engine: a kinematic tree, and for each of its links the shapes,
// the inertial and the surface. Constant; shared by any number of worlds.
struct ArticulatedBody {
  std::shared_ptr<const assets::KinematicModel> kinematics;
  std::vector<RigidBody> links;  // by link of `kinematics`, each in its own frame

  const std::string& name() const { return kinematics->name(); }
  const std::vector<assets::Joint>& joints() const { return kinematics->joints(); }
};

// Converts any URDF whose moving links have inertials; collision meshes are taken as convex. A link
// may lack an inertial as the root of a fixed body and on a fixed joint (a tool frame). Throws
// core::Error, naming the link, for a moving link without an inertial, and for floating or planar
// joints.
ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model);
// Does the same with `kinematics`, the model's own tree, which is then shared.
ArticulatedBody ArticulatedBodyFrom(const assets::UrdfModel& model,
                                    std::shared_ptr<const assets::KinematicModel> kinematics);

// Converts a single rigid body to an articulated body without joints.
ArticulatedBody ArticulatedBodyFrom(const RigidBody& body);

}  // namespace simwright::sim
