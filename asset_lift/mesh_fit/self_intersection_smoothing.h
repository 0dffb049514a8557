#pragma once

#include "core/mesh.h"

namespace simwright::asset_lift {

// Smooths a closed mesh locally where it intersects itself: the vertices of intersecting faces and
// of their neighbours move to the mean of their neighbours. The neighbourhood grows each round, for
// at most `rounds` rounds. Returns true if no face intersects another or is degenerate any more.
// The connectivity is unchanged.
bool SmoothSelfIntersections(core::TriangleMesh* mesh, int rounds);

}  // namespace simwright::asset_lift
