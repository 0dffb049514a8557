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

// Computes the mass properties of the solid bounded by `mesh` at `density` (kg / m^3): the volume
// integrals of 1, x and x x^T as sums over triangles by the divergence theorem (exact for a
// polyhedron: F. Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor", 2004),
// taken about the centre of the AABB so that a far origin costs no digits. Throws core::Error for
// an invalid or empty mesh, a density that is not positive and finite, or a volume that is not
// positive (an open or inside-out surface).
MassProperties SolidMassProperties(const core::TriangleMesh& mesh, double density);

// Computes the mass properties of a sheet on the surface: the area integrals times `wall_thickness`
// (m), the limit of a thin wall. Throws core::Error for an invalid mesh, no area, or a thickness or
// density that is not positive.
MassProperties ShellMassProperties(const core::TriangleMesh& mesh, double wall_thickness,
                                   double density);

// Computes the mass properties of a hollow body: a wall of `wall_thickness` (m) inside the closed
// surface `mesh`, of `density` (kg / m^3). With V and A the enclosed volume and the area, the
// cavity is assumed to have volume s^3 V with s = 1 - thickness A / (3 V), and the centre and the
// inertia per mass to be w times the sheet's plus 1 - w times the solid's, w = 3/2 ((1 - s^5) / (1
// - s^3) - 1). This is exact for a surface whose faces all touch one inscribed sphere (sphere,
// cube, regular polyhedra), and tends to the sheet for thin walls and to the solid for thick ones
// on any surface. Throws core::Error as SolidMassProperties does, and for a thickness outside (0, 3
// V / A).
MassProperties HollowMassProperties(const core::TriangleMesh& mesh, double wall_thickness,
                                    double density);

// Returns the wall thickness (m) at which the walls of a hollow body of enclosed `volume` (m^3) and
// `area` (m^2) fill the share `fill` of its volume, 0 < fill < 1: 3 V / A (1 - cbrt(1 - fill));
// fill V / A for thin walls. Throws core::Error for arguments out of these ranges.
double WallThickness(double fill, double volume, double area);

// Returns the mass properties of two bodies rigidly joined; volumes and masses add. Throws
// core::Error if the total mass is not positive.
MassProperties Combined(const MassProperties& a, const MassProperties& b);

// Returns the mass properties after a rigid transform of the frame.
MassProperties Transformed(const Eigen::Isometry3d& target_from_source,
                           const MassProperties& properties);

struct PrincipalInertia {
  Eigen::Vector3d moments = Eigen::Vector3d::Zero();         // kg m^2, ascending
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();  // body_from_principal
};

// Diagonalises `inertia` = R diag(moments) R^T with R = axes (right-handed). Throws core::Error if
// `inertia` is not finite or not symmetric to 1e-6 of its norm.
PrincipalInertia PrincipalInertiaOf(const Eigen::Matrix3d& inertia);

// Returns true if a rigid body can have these principal moments: all are positive, and none exceeds
// the sum of the other two (to `tolerance` of the largest; a flat plate satisfies it with
// equality).
bool SatisfiesTriangleInequality(const Eigen::Vector3d& moments, double tolerance = 1e-9);

}  // namespace simwright::geometry
