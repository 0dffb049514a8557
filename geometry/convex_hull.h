#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// The convex hull of `points` (m): a closed, outward triangle mesh, every vertex one of `points`.
// Points nearer to a face than 1e-7 of the bounding box's diagonal count as on it and are left
// out, so that coplanar sets give no slivers inside a face.
// Where that fails in rounded arithmetic (thousands of nearly coplanar points) it is
// geometry/exact_hull.h's, which keeps them.
// With `max_vertices` >= 4 the hull stops after that many vertices, each the one that sticks out
// farthest of what was there before: it then lies inside the full hull.
// Throws core::Error for fewer than 4 points, coordinates that are not finite, `max_vertices`
// between 1 and 3, or a flat set (thinner than 1e-6 of its diagonal): a flat set has no volume.
// See ThickenedConvexHull.
core::TriangleMesh ConvexHull(const std::vector<Eigen::Vector3d>& points, int max_vertices = 0);

// As ConvexHull, but a flat, straight or single point set is first thickened to `min_thickness`
// (m, > 0) by points to both sides of it along each direction in which it is thinner than that.
core::TriangleMesh ThickenedConvexHull(const std::vector<Eigen::Vector3d>& points,
                                       double min_thickness, int max_vertices = 0);

}  // namespace simwright::geometry
