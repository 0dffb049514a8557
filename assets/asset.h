#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/finding.h"
#include "core/mesh.h"
#include "physics_params/physical_parameters.h"

namespace simwright::assets {

// The mass, the centre of mass and the inertia about it, in the link's frame.
struct Inertial {
  double mass = 0.0;                                         // kg
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();  // m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();     // kg m^2, about center_of_mass
};

// A rigid, simulation-ready object. All meshes are in the link frame: metres, z up in the rest
// pose, z = 0 at the supporting surface, the origin at the centre of its base.
struct Asset {
  std::string name;  // name of its folder and files: letters, digits, '_', '-'
  physics_params::PhysicalParameters parameters;  // ranges and samples by category

  core::TexturedMesh visual;
  core::TriangleMesh solid;               // closed, outward, free of self-intersections
  std::vector<core::TriangleMesh> parts;  // closed, convex, cover the solid

  Inertial inertial;
  double volume = 0.0;           // m^3, enclosed by the solid
  double density = 0.0;          // kg/m^3, of the material
  double wall_thickness = 0.0;   // m, inside the solid's surface; 0 if the solid is full
  bool wall_on_surface = false;  // folders of earlier versions: the wall is a sheet on the surface
  std::string mass_sentence;     // how mass, volume and material were reconciled
  double friction = 0.5;
  double restitution = 0.1;
  // The lever arm of the normal force that resists rolling, m: 0.01 of the mean radius, as for
  // fruit, wood and soft plastic on a table (handbook coefficients span 0.002 to 0.03). Without it
  // an object on round facets rocks indefinitely.
  double rolling_friction = 0.0;

  std::string solid_method;      // how the solid was computed from the visual mesh
  double sheet_thickness = 0.0;  // m, the thickness given to open sheets; 0 if there were none
  double concavity = 0.0;        // of the parts, relative to the diagonal
  double coverage = 0.0;         // share of the solid's surface covered by the parts

  // link = scale * rotation * input + translation: the transform from the file or photo.
  double scale = 1.0;
  Eigen::Isometry3d link_from_input = Eigen::Isometry3d::Identity();
  bool rolls = false;  // rests on a point or line: judged by its drift alone

  std::string source;  // the photo or mesh it was made from, file name only
  std::uint64_t seed = 0;
  core::Findings findings;  // notes on its creation for the user
};

// Returns `text` as a valid name for files and links: other characters become '_'; never empty, no
// leading dot.
std::string FileSafeName(const std::string& text);

}  // namespace simwright::assets
