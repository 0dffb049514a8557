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

// The key and value in ArticulatedAsset::features that mark an imported URDF as a robot rather than
// an object.
inline constexpr const char* kKindFeature = "kind";
inline constexpr const char* kRobotKind = "robot";

// A rigid link of an articulated object. Meshes are in the link's frame, metres.
struct ArticulatedLink {
  std::string name;           // "door", "handle_0": letters, digits, '_'
  std::string label;          // the part's role: "door", "handle" (docs/formats.md lists them)
  core::TexturedMesh visual;  // each material a colour, and a texture at most
  std::vector<core::TriangleMesh> parts;  // closed, convex, outward
  std::vector<double> densities;          // kg/m^3, one per part; they determine the inertial
  Inertial inertial;
  double volume = 0.0;   // m^3, of its material
  std::string material;  // the material of most of its mass
  double friction = 0.5;
  double restitution = 0.1;
};

// An articulated, simulation-ready object. The root's frame: z up, z = 0 at the supporting surface,
// the origin at the centre of its base, the front towards -x. At position zero every joint is
// closed, off or up.
struct ArticulatedAsset {
  std::string name;    // name of its folder and files: letters, digits, '_', '-'
  std::string source;  // the generator, e.g. "library/microwave"
  physics_params::PhysicalParameters parameters;  // ranges and samples by category
  // True if it is mounted on a wall, a floor or a counter (doors, faucets); otherwise it stands
  // free on the floor.
  bool fixed = false;
  std::vector<ArticulatedLink> links;  // the root first; parents precede their children
  std::vector<Joint> joints;           // joints[i] leads to links[i + 1]
  // The pairs of links that overlap at their joint by design: contacts between them are disabled in
  // every format (MuJoCo and SAPIEN disable contacts between a parent and its child by default).
  std::vector<ExcludedPair> excluded_pairs = {};
  std::map<std::string, std::string> features;  // sampled features: "handle" -> "bar"
  std::uint64_t seed = 0;
  core::Findings findings;  // notes on its generation for the user
};

bool IsRobot(const ArticulatedAsset& asset);

// Returns the asset as a model for physics engines: collision parts, inertials and joints; no
// visuals.
UrdfModel ModelOf(const ArticulatedAsset& asset);

// Returns mass, centre of mass and inertia of all links as one body, in the root's frame.
Inertial CombinedInertial(const UrdfModel& model,
                          const std::map<std::string, double>& positions = {});

// Appends a visual with its materials and textures; equal textures are kept once.
void AppendVisual(const core::TexturedMesh& addition, core::TexturedMesh* visual);

// Returns all visuals as one mesh in the root's frame, with the joints at `positions` (by name; rad
// or m).
core::TexturedMesh VisualAtPositions(const ArticulatedAsset& asset,
                                     const std::map<std::string, double>& positions = {});

// Returns the AABB of all visuals in the root's frame, with the joints at zero.
Eigen::AlignedBox3d BoundsAtZero(const ArticulatedAsset& asset);

}  // namespace simwright::assets
