#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::assets {

// Return closed, outward-oriented meshes centred at the origin; metres. `segments` >= 3 around the
// axis. The vertices lie on the exact surface.
core::TriangleMesh BoxMesh(const Eigen::Vector3d& size);
core::TriangleMesh CylinderMesh(double radius, double length, int segments = 48);  // along z
core::TriangleMesh SphereMesh(double radius, int segments = 32);
// Returns the set of points within `radius` of a segment of `length` along z.
core::TriangleMesh CapsuleMesh(double radius, double length, int segments = 32);

}  // namespace simwright::assets
