#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct SelfIntersectionSmoothing {
  int rounds = 15;        // the largest number of rounds
  double max_move = 0.0;  // m, the largest distance of a vertex from where it was; 0: no limit
  // Only counts intersections within a component (EdgeComponents): components that intersect each
  // other can be united.
  bool within_components = false;
  // Cuts out the faces that smoothing leaves intersecting, with those around them, and fills the
  // holes. Unused vertices stay.
  bool replaces_faces = false;
};

// Smooths a closed mesh locally where it intersects itself: the vertices of intersecting faces and
// of their neighbours move to the mean of their neighbours. The neighbourhood grows with the
// rounds. Returns true if no face intersects another or is degenerate any more. The connectivity is
// unchanged.
bool SmoothSelfIntersections(core::TriangleMesh* mesh, const SelfIntersectionSmoothing& options);

}  // namespace simwright::geometry
