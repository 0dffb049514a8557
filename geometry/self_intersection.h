#pragma once

#include <utility>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// Returns pairs of faces (lower index first, ascending) that meet elsewhere than in the vertices
// they share, decided with exact predicates; at most `limit` of them. Faces of zero area are
// skipped: they are reported as degenerate. Accepts any mesh that core::RequireValid accepts.
std::vector<std::pair<int, int>> SelfIntersections(const core::TriangleMesh& mesh, int limit);

// Returns true if the triangle's corners are collinear in exact arithmetic.
bool IsDegenerate(const core::TriangleMesh& mesh, int triangle);

}  // namespace simwright::geometry
