#pragma once

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// Returns the intersection of a convex mesh with the half-space normal . x <= offset, as a hull of
// at most `max_vertices` vertices; empty if it has no volume.
core::TriangleMesh CutConvex(const core::TriangleMesh& convex, const Eigen::Vector3d& normal,
                             double offset, int max_vertices = 64);

}  // namespace simwright::geometry
