#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::assets {

// Returns a unit normal per corner (3 M): the mean of the faces about the vertex that are turned by
// less than 40 degrees, so that round surfaces look round and edges sharp. Vertices of more than
// 2048 faces, the middles of large fans, keep the faces' own normals: every pair of their faces
// would be compared. A face without area has the z axis.
std::vector<Eigen::Vector3d> CornerNormals(const core::TriangleMesh& mesh);

}  // namespace simwright::assets
