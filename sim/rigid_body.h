#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/asset.h"
#include "assets/urdf_reader.h"
#include "core/mesh.h"

namespace simwright::sim {

// A capsule: all points within `radius` of the segment from a to b, m, in the body's frame.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// The description of a rigid body for a physics engine. Constant; shared by any number of worlds.
struct RigidBody {
  std::string name;
  std::vector<core::TriangleMesh> parts;  // convex, in the body's frame, metres
  assets::Inertial inertial;              // in the body's frame
  double friction = 0.5;
  double restitution = 0.0;
  double rolling_friction = 0.0;  // m: lever arm of the rolling resistance over the normal force
  // The capsule of parts[i], if it is one: cheaper to collide, and round. May be shorter than
  // `parts`.
  std::vector<std::optional<Capsule>> capsules = {};
  // m: lever arm of the resistance to turning about the normal of a contact, over the friction
  // force; none: rolling_friction. ArticulatedWorld only.
  std::optional<double> torsional_friction = std::nullopt;
};

RigidBody BodyFromAsset(const assets::Asset& asset);

// Merges all links of a URDF into one body, with every joint at zero; collision meshes are taken as
// convex. Throws core::Error if no link has a collision shape, or none has a mass.
RigidBody BodyFromUrdf(const assets::UrdfModel& model);

// Returns a closed, sphere-like body of given radius (m) and mass (kg), for probes.
RigidBody SphereBody(double radius, double mass);

// Returns the lowest z of all parts at `world_from_body`.
double LowestPoint(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

// Returns the largest distance (m) of a vertex from the centre of mass.
double Radius(const RigidBody& body);

}  // namespace simwright::sim
