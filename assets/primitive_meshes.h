#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::assets {

// Closed, outward meshes about the origin; metres. `segments` >= 3 round the axis. The vertices
// lie on the true surface.
core::TriangleMesh BoxMesh(const Eigen::Vector3d& size);
core::TriangleMesh CylinderMesh(double radius, double length, int segments = 48);  // along z
core::TriangleMesh SphereMesh(double radius, int segments = 32);
// All points within `radius` of a segment of `length` along z.
core::TriangleMesh CapsuleMesh(double radius, double length, int segments = 32);

}  // namespace simwright::assets
