#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// Returns the convex hull of `points` by CGAL's exact predicates: correct for any points, and about
// ten times slower than geometry/quickhull.h. Closed, oriented outward, with vertices among the
// points; nearly coplanar points stay and make slender triangles. `max_vertices` > 0 (>= 4) limits
// the vertices, chosen by farthest-point selection. Empty if the points are flat.
core::TriangleMesh ExactHull(const std::vector<Eigen::Vector3d>& points, int max_vertices);

}  // namespace simwright::geometry
