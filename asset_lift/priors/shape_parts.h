#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::asset_lift {

// The closed parts from which training shapes are assembled. All are centred on the origin unless
// noted.

core::TriangleMesh BoxPart(const Eigen::Vector3d& size);

// Returns a solid of revolution about z. The profile holds (radius, z) from the lower end of the
// axis to its upper end; where the first or last radius is not 0, a disc closes the end. A profile
// that runs up outside and down inside makes a vessel.
core::TriangleMesh RevolvedPart(const std::vector<Eigen::Vector2d>& profile, int segments);

// Returns a superquadric |x/a|^(2/e2) ... (Barr 1981): round at exponents of 1, a box towards 0, an
// octahedron at 2.
core::TriangleMesh SuperquadricPart(const Eigen::Vector3d& half_size, double exponent_z,
                                    double exponent_xy, int segments);

// Returns a tube of `radius` along a polyline of at least two points, closed by discs.
core::TriangleMesh TubePart(const std::vector<Eigen::Vector3d>& path, double radius, int segments);

}  // namespace simwright::asset_lift
