#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "assets/asset.h"
#include "assets/urdf_reader.h"
#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/physical_parameters.h"

namespace simwright::assets {

// ArticulatedAsset::features: the kind of a foreign URDF that is a robot, no thing for one.
inline constexpr const char* kKindFeature = "kind";
inline constexpr const char* kRobotKind = "robot";

// One rigid part of a jointed thing. Meshes are in the link's frame, metres.
struct ArticulatedLink {
  std::string name;           // "door", "handle_0": letters, digits, '_'
  std::string label;          // what it is: "door", "handle" (docs/formats.md lists them)
  core::TexturedMesh visual;  // colours by material, no textures
  std::vector<core::TriangleMesh> parts;  // closed, convex, outward
  std::vector<double> densities;          // kg/m^3, a part each; they give the inertial
  Inertial inertial;
  double volume = 0.0;   // m^3, of its matter
  std::string material;  // that most of its mass is made of
  double friction = 0.5;
  double restitution = 0.1;
};

// A jointed, simulation-ready thing. The root's frame: z up, z = 0 where it stands, the origin at
// the centre of its base, the front towards -x. Every joint at zero is closed, off or up.
struct ArticulatedAsset {
  std::string name;    // of its folder and files: letters, digits, '_', '-'
  std::string source;  // what made it, e.g. "library/microwave"
  physics_params::PhysicalParameters parameters;  // ranges and samples by category
  // Held to a wall, a floor or a counter (doors, faucets); else it stands on the floor, free.
  bool fixed = false;
  std::vector<ArticulatedLink> links;  // the root first; a parent stands before its children
  std::vector<UrdfJoint> joints;       // joints[i] leads to links[i + 1]
  // Links that overlap where their joint has them overlap: no contact is made of them, in any
  // format (MuJoCo and SAPIEN make none between a parent and its child by default).
  std::vector<ExcludedPair> excluded_pairs = {};
  std::map<std::string, std::string> features;  // what was drawn: "handle" -> "bar"
  std::uint64_t seed = 0;
  core::Findings findings;  // what a person should know of its making
};

bool IsRobot(const ArticulatedAsset& asset);

// The same thing as a model for the engines: collision parts, inertials, joints; no visuals.
UrdfModel ModelOf(const ArticulatedAsset& asset);

// Mass, centre and inertia of all links as one body, in the root's frame.
Inertial WholeInertial(const UrdfModel& model, const std::map<std::string, double>& positions = {});

// All visuals as one mesh in the root's frame, joints at `positions` (by name; rad or m).
core::TexturedMesh PosedVisual(const ArticulatedAsset& asset,
                               const std::map<std::string, double>& positions = {});

// All visuals' bounds in the root's frame, joints at zero.
Eigen::AlignedBox3d BoundsAtZero(const ArticulatedAsset& asset);

}  // namespace simwright::assets
