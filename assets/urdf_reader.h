#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "assets/asset.h"
#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::assets {

// A shape of a link, as a mesh in the link's frame. Boxes, cylinders and spheres are meshed.
struct UrdfShape {
  core::TriangleMesh mesh;  // metres, scale and origin applied
  std::string file;         // the mesh file, absolute; empty for a primitive
};

struct UrdfLink {
  std::string name;
  std::optional<Inertial> inertial;  // in the link's frame; none where the file gives none
  std::vector<UrdfShape> visuals;
  std::vector<UrdfShape> collisions;
  double friction = 0.5;  // <contact><lateral_friction>, where given
  double restitution = 0.0;
  double rolling_friction = 0.0;  // <contact><rolling_friction>, m
};

enum class UrdfJointType { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar };

struct UrdfJoint {
  std::string name, parent, child;
  UrdfJointType type = UrdfJointType::kFixed;
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();  // at position zero
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();                      // joint frame, unit
  double lower = 0.0, upper = 0.0;                                      // rad or m
};

struct UrdfModel {
  std::string name;
  std::vector<UrdfLink> links;    // the root first; a parent stands before its children
  std::vector<UrdfJoint> joints;  // joints[i] leads to links[i + 1]
  core::Findings findings;        // what was missing or mended
};

struct UrdfReadOptions {
  // No file outside this folder is read. Empty: the URDF's own folder, or the one above it where
  // that folder is called "urdf" (a ROS package keeps "../meshes" there).
  std::filesystem::path root;
};

// Reads a URDF with urdfdom. Mesh names may be relative, "file://", "../meshes/x" inside the root,
// or "package://NAME/x": x is then looked for in the root, the URDF's folder and the folders above
// it inside the root. A mesh that is missing or cannot be read is left out with a warning, a
// missing inertial is reported.
// Throws core::Error: no XML or no URDF, larger than 16 MiB, a DOCTYPE or entity, a loop, a joint
// to a missing link, no root, a mass that is not positive, an inertia that no body can have, a
// mesh path that leads outside the root.
UrdfModel ReadUrdf(const std::filesystem::path& path, const UrdfReadOptions& options = {});

// Pose of each link in the frame of the root, all joints at zero.
std::vector<Eigen::Isometry3d> LinkPosesAtZero(const UrdfModel& model);

}  // namespace simwright::assets
