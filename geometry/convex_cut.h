#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// What the half-space normal . x <= offset leaves of a convex mesh, as a hull of at most
// `max_vertices` vertices; empty where that is nothing with a volume.
core::TriangleMesh CutConvex(const core::TriangleMesh& convex, const Eigen::Vector3d& normal,
                             double offset, int max_vertices = 64);

}  // namespace simwright::geometry
