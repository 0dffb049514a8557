#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// Returns the same faces with one vertex for each fan of faces: bodies that touch along an edge or
// at a vertex, as the cells of a voxel surface do, no longer share it. At an edge of four faces or
// more, the faces that have the solid between them stay joined. `mesh` is oriented; edges with
// other faces than a closed surface has come apart.
core::TriangleMesh SplitNonManifold(const core::TriangleMesh& mesh);

}  // namespace simwright::geometry
