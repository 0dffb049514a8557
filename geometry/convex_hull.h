#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// Returns the convex hull of `points` (m): a closed triangle mesh, oriented outward, whose vertices
// are all input points. Points within 1e-7 of the AABB's diagonal of a face count as on it and are
// left out, so that coplanar sets give no slivers inside a face. If rounding errors make that fail
// (thousands of nearly coplanar points), the hull comes from geometry/exact_hull.h, which keeps
// such points. With `max_vertices` >= 4 the hull stops at that many vertices, each the one farthest
// outside the hull so far; the result then lies inside the full hull. Throws core::Error for fewer
// than 4 points, coordinates that are not finite, `max_vertices` between 1 and 3, or a flat set
// (thinner than 1e-6 of its diagonal), which has no volume. See ThickenedConvexHull.
core::TriangleMesh ConvexHull(const std::vector<Eigen::Vector3d>& points, int max_vertices = 0);

// Computes ConvexHull, but first thickens a flat, collinear or single-point set to `min_thickness`
// (m, > 0) by adding points on both sides along each direction in which it is thinner than that.
core::TriangleMesh ThickenedConvexHull(const std::vector<Eigen::Vector3d>& points,
                                       double min_thickness, int max_vertices = 0);

}  // namespace simwright::geometry
