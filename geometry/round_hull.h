#pragma once

#include <optional>

#include "core/mesh.h"

namespace simwright::geometry {

// A polyhedron of at most `max_vertices` (>= 16) that stands for `hull` (closed, convex) where that
// is round, up to a stretch along its principal axes: an ellipsoid, or a solid of revolution (also
// of an elliptic section) such as a cylinder, a cone, a frustum, a capsule or a lens. It has the
// hull's volume, axis and extent along the axis, regular rings of 6 to 32 corners, and flat ends of
// the area that the hull's have. Empty where the hull
// is not round.
std::optional<core::TriangleMesh> SimplifyRoundHull(const core::TriangleMesh& hull,
                                                    int max_vertices);

}  // namespace simwright::geometry
