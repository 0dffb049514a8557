#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

// Fast thinning of any triangles, also millions: vertices of one grid cell of edge `cell` (metres)
// fall together in the one nearest their mean; faces that vanish or repeat are dropped.
// No vertex moves farther than cell * sqrt(3). Throws core::Error for cell <= 0.
core::TriangleMesh ClusterVertices(const core::TriangleMesh& mesh, double cell);

}  // namespace simwright::geometry
