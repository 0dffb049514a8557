#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/asset.h"
#include "assets/joint.h"
#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::assets {

enum class UrdfGeometry { kMesh, kBox, kCylinder, kSphere };

// A shape of a link, as a mesh in the link's frame. Boxes, cylinders and spheres are meshed.
struct UrdfShape {
  core::TriangleMesh mesh;  // metres, scale and origin applied
  std::string file;         // the mesh file, absolute; empty for a primitive
  // The transform of the file's vertices, scale and origin; identity for a primitive.
  Eigen::Affine3d link_from_file = Eigen::Affine3d::Identity();
  char up = 0;  // the up axis declared by the file (MeshFile), before any rotation
  std::optional<Eigen::Vector4f> color = std::nullopt;  // RGBA of a visual's <material>
  // The exact primitive, for engines that support it.
  UrdfGeometry geometry = UrdfGeometry::kMesh;
  double radius = 0.0, length = 0.0;  // m, of a cylinder (along z) or sphere
  Eigen::Isometry3d link_from_primitive = Eigen::Isometry3d::Identity();
};

struct UrdfLink {
  std::string name;
  std::optional<Inertial> inertial;  // in the link's frame; none if the file gives none
  std::vector<UrdfShape> visuals;
  std::vector<UrdfShape> collisions;
  double friction = 0.5;  // <contact><lateral_friction>, if given
  double restitution = 0.0;
  double rolling_friction = 0.0;  // <contact><rolling_friction>, m
};

// The content of a URDF, which importers edit. KinematicModel (kinematic_model.h) is the immutable
// tree made from it.
struct UrdfModel {
  std::string name;
  std::vector<UrdfLink> links;                    // the root first; parents precede their children
  std::vector<Joint> joints;                      // joints[i] leads to links[i + 1]
  std::vector<ExcludedPair> excluded_pairs = {};  // by <drake:collision_filter_group>
  core::Findings findings = {};                   // missing and repaired content
  bool root_is_world = false;  // the root is the world frame: a simulator must fix it
};

struct UrdfReadOptions {
  // The folder outside of which no file is read. Empty: PackageRootOf the URDF (urdf_meshes.h).
  std::filesystem::path root;
  // If true, an impossible inertial is a finding, not an error, for callers that recompute
  // inertials. A mass that is not positive leaves the link without an inertial; an impossible
  // inertia is replaced by that of the bounding box of the link's shapes with the same mass.
  bool repair_inertials = false;
};

// Reads a URDF with urdfdom, which parses the output of RepairUrdfText; meshes are found by
// MeshFinder. A mesh that is missing or cannot be read is skipped with a warning; a missing
// inertial and a mimic joint are reported. A link without shapes may have mass zero: it is a frame.
// Drake's collision filter groups that name one link each become excluded pairs. Throws core::Error
// for: no XML or no URDF, an unexpanded xacro, more than 16 MiB, a DOCTYPE or entity, a loop, a
// joint to a missing link, no root, a mass that is not positive, a physically impossible inertia,
// joint damping, friction or limits that are not finite, negative damping or friction, a mesh path
// that leads outside the root.
UrdfModel ReadUrdf(const std::filesystem::path& path, const UrdfReadOptions& options = {});

}  // namespace simwright::assets
