#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

struct MassProperties {
  double volume = 0.0;                                       // m^3 (of the material)
  double mass = 0.0;                                         // kg
  Eigen::Vector3d center_of_mass = Eigen::Vector3d::Zero();  // m, in the mesh's frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();         // kg m^2, about center_of_mass
};

// Mass properties of the solid that `mesh` bounds, filled with `density` (kg / m^3): the volume
// integrals of 1, x and x x^T turned into sums over triangles by the divergence theorem (exact for
// a polyhedron: F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2004),
// taken about the middle of the bounds so that a far origin costs no digits.
// Throws core::Error for an invalid or empty mesh, a density that is not positive and finite, or
// a volume that is not positive (an open or inside-out surface).
MassProperties SolidMassProperties(const core::TriangleMesh& mesh, double density);

// The same of a thin wall: the surface's area integrals times `wall_thickness` (m). The wall lies
// on the surface; nothing is said of a wall that is thick against the body.
// Throws core::Error for an invalid mesh, no area, or a thickness or density that is not positive.
MassProperties ShellMassProperties(const core::TriangleMesh& mesh, double wall_thickness,
                                   double density);

// Several bodies taken as one rigid one; volumes and masses add. Throws core::Error when the total
// mass is not positive.
MassProperties Combined(const MassProperties& a, const MassProperties& b);

// The same body after a rigid motion of its frame.
MassProperties Transformed(const Eigen::Isometry3d& target_from_source,
                           const MassProperties& properties);

struct PrincipalInertia {
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();         // kg m^2, ascending
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  // body_from_principal
};

// inertia = R diag(moments) R^T with R = axes (right-handed). Throws core::Error when `inertia` is
// not finite or not symmetric to 1e-6 of its norm.
PrincipalInertia PrincipalInertiaOf(const Eigen::Matrix3d& inertia);

// Whether a rigid body can have these principal moments: all positive, and none above the sum of
// the other two (to `tolerance` of the largest; a flat plate meets it with equality).
bool SatisfiesTriangleInequality(const Eigen::Vector3d& moments, double tolerance = 1e-9);

}  // namespace simwright::geometry
