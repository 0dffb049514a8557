#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// Simplifies any triangles, even millions, by vertex clustering: the vertices of one grid cell of
// edge `cell` (metres) merge into the one nearest their mean; faces that vanish or repeat are
// dropped. No vertex moves farther than cell * sqrt(3). Throws core::Error for cell <= 0.
core::TriangleMesh ClusterVertices(const core::TriangleMesh& mesh, double cell);

}  // namespace simwright::geometry
