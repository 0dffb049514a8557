#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// Returns the surface of the union of a mesh's components (as numbered by EdgeComponents), computed
// by corefinement (CGAL), with the number of components in `*count`. Returns an empty mesh if there
// are not 2 to 64 components, if one of them alone is not a solid (mesh_validity.h), or if rounded
// coordinates leave the union with intersecting faces. Components may contain and touch each other.
core::TriangleMesh UnionOfComponents(const core::TriangleMesh& mesh, int* count);

}  // namespace simwright::geometry
