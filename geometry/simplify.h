#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct SimplifyOptions {
  int face_budget = 20000;
  // No collapse moves the surface farther than this from the planes it replaces, root mean square
  // by area, metres; 0: the budget alone decides.
  double max_error = 0.0;
  // What the mean hides: a groove or a spike of little area that is gone. Farthest that each of up
  // to four descents may move a vertex or some point (sampled) of either surface from the other,
  // metres; what is nearby then stays as it was. 0: not watched.
  double max_distance = 0.0;
};

// Edge collapses by quadric error (Garland and Heckbert 1997) that keep the topology: a closed,
// manifold mesh stays closed and manifold, and collapses that would turn a face over are refused.
// A mesh that was free of self-intersections stays so: collapses that made one, or moved something
// beyond `max_distance`, are taken back in its neighbourhood, which may leave more faces than the
// budget.
// Returns the simplified mesh. Throws core::Error for a mesh that is not closed and manifold.
core::TriangleMesh Simplify(const core::TriangleMesh& mesh, const SimplifyOptions& options);

}  // namespace simwright::geometry
