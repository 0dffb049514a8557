#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// Returns true if the triangles bound a volume: each edge has as many faces in one direction as in
// the other. Vertices at bit for bit equal positions count as one. O(M log M).
bool IsClosed(const core::TriangleMesh& mesh);

}  // namespace simwright::geometry
