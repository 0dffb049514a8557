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

// All points within `radius` of the segment from a to b, m, in the body's frame.
struct Capsule {
  Eigen::Vector3d a = Eigen::Vector3d::Zero(), b = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// What a physics engine needs of one rigid thing. Constant; shared by any number of worlds.
struct RigidBody {
  std::string name;
  std::vector<core::TriangleMesh> parts;  // convex, in the body's frame, metres
  assets::Inertial inertial;              // in the body's frame
  double friction = 0.5;
  double restitution = 0.0;
  double rolling_friction = 0.0;  // m: the lever of the normal force that resists rolling
  // Of parts[i], where it truly is a capsule: cheaper to collide, and round. May be shorter.
  std::vector<std::optional<Capsule>> capsules = {};
};

RigidBody BodyFromAsset(const assets::Asset& asset);

// All links of a URDF as one body, every joint held at zero; collision meshes are taken as convex.
// Throws core::Error where no link has a collision shape, or none has a mass.
RigidBody BodyFromUrdf(const assets::UrdfModel& model);

// A closed sphere-like body of given radius (m) and mass (kg), for probes.
RigidBody SphereBody(double radius, double mass);

// Lowest z of all parts at `world_from_body`.
double LowestPoint(const RigidBody& body, const Eigen::Isometry3d& world_from_body);

// Farthest distance of a vertex from the centre of mass: the body's size, m.
double Radius(const RigidBody& body);

}  // namespace simwright::sim
