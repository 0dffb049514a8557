#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// A simplified mesh, and for each vertex the index of the identical original vertex, or -1.
struct Thinned {
  core::TriangleMesh mesh;
  std::vector<int> sources;
};

// Collapses edges of a manifold mesh in order of quadric error (Garland and Heckbert 1997), until
// `budget` faces are left or the next collapse would move the surface by more than `max_error` (m,
// 0: no limit), root mean square over the faces it replaces. Preserves the topology. No collapse
// flips a face, but faces may come to intersect others. Vertices whose `locked` (one per vertex) is
// set stay. Throws core::Error if the number of locks differs from that of vertices;
// core::Cancelled.
Thinned CollapseEdges(const core::TriangleMesh& mesh, const std::vector<char>& locked, int budget,
                      double max_error);

}  // namespace simwright::geometry
