#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// Simplifies `hull` (closed, convex, oriented outward) to a convex mesh of at most `max_vertices`
// (>= 16) vertices; returns `hull` itself if it has no more. Preserves the volume (within 1 % if
// that many vertices allow it); the planes and areas of flat sides, so that the support polygon
// stays and no crack opens to a neighbour; and the symmetry: round hulls become regular
// (geometry/round_hull.h), others keep their mirror planes along the axes or the principal axes.
// Throws core::Error for a limit below 16.
core::TriangleMesh SimplifyHull(const core::TriangleMesh& hull, int max_vertices);

}  // namespace simwright::geometry
