#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// A mesh made from another one, and for each vertex the other's that it still is, or -1.
struct Thinned {
  core::TriangleMesh mesh;
  std::vector<int> sources;
};

// Collapses edges of a manifold mesh, the cheapest by quadric error first (Garland and Heckbert
// 1997), until `budget` faces are left or the next would move the surface by more than `max_error`
// (m, 0: any), root mean square over the faces it replaces. The topology stays; faces do not turn
// over where they are, but may come to cross others. Vertices with `locked` (one a vertex) stay.
// Throws core::Error where the number of locks is not that of vertices; core::Cancelled.
Thinned CollapseEdges(const core::TriangleMesh& mesh, const std::vector<char>& locked, int budget,
                      double max_error);

}  // namespace simwright::geometry
