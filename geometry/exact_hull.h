#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// The convex hull of `points` by CGAL's exact predicates: right whatever the points, and some ten
// times slower than geometry/quickhull.h. Closed, outward, on some of the given points; nearly
// coplanar points stay and make slender triangles.
// `max_vertices` > 0: of that many vertices at most (>= 4), each next one the farthest from those
// taken. Empty where the points are flat.
core::TriangleMesh ExactHull(const std::vector<Eigen::Vector3d>& points, int max_vertices);

}  // namespace simwright::geometry
