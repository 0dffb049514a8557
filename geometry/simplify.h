#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct SimplifyOptions {
  int face_budget = 20000;
  // The largest distance (metres) of the surface after any collapse from the planes it replaces,
  // root mean square by area; 0: only the budget counts.
  double max_error = 0.0;
  // The largest distance (metres) that each of up to four simplification passes may move a vertex
  // or a sampled point of either surface from the other surface; a violation restores the
  // neighbourhood. This catches losses that the mean hides: grooves or spikes of little area. 0:
  // not checked.
  double max_distance = 0.0;
};

// Simplifies by edge collapses ordered by quadric error (Garland and Heckbert 1997) that preserve
// the topology: a closed, manifold mesh stays closed and manifold, and collapses that would flip a
// face are refused. A mesh without self-intersections stays so: collapses that create one, or move
// the surface beyond `max_distance`, are undone in their neighbourhood, which may leave more faces
// than the budget. Throws core::Error for a mesh that is not closed and manifold.
core::TriangleMesh Simplify(const core::TriangleMesh& mesh, const SimplifyOptions& options);

}  // namespace simwright::geometry
