#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// A convex mesh of at most `max_vertices` (>= 16) vertices that stands for `hull` (closed, convex,
// outward); `hull` itself where it has no more. It has the volume of `hull` (within 1 % where that
// many vertices allow it), its flat sides stay in their planes and keep their area, so that it
// stands on the same support polygon and no crack opens to a neighbour, and it is as symmetric as
// `hull`: round ones become regular (geometry/round_hull.h), others keep their mirror planes along
// the axes or the principal axes.
// Throws core::Error for a limit below 16.
core::TriangleMesh SimplifyHull(const core::TriangleMesh& hull, int max_vertices);

}  // namespace simwright::geometry
