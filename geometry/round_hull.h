#pragma once

#include <optional>

#include "core/mesh.h"

namespace simwright::geometry {

// Approximates `hull` (closed, convex) by a polyhedron of at most `max_vertices` (>= 16) if it is
// round up to scaling along its principal axes: an ellipsoid, or a solid of revolution (also with
// elliptic section) such as a cylinder, a cone, a frustum, a capsule or a lens. The polyhedron has
// the hull's volume, axis and extent along the axis, regular rings of 6 to 32 corners, and flat
// ends of the hull's area. Returns nothing if the hull is not round.
std::optional<core::TriangleMesh> SimplifyRoundHull(const core::TriangleMesh& hull,
                                                    int max_vertices);

}  // namespace simwright::geometry
