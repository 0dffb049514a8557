#pragma once

#include <vector>

#include "core/mesh.h"

namespace simwright::asset_lift {

// Returns the mesh's surface area over the square of `unit` (m) and adds `weight` times its
// derivative by the vertices, 1/m, to `gradient` (N x 3). Of all surfaces that fit the outlines,
// the one of least area has no bulges between the places where outlines touch it.
double AddAreaPenalty(const core::TriangleMesh& mesh, double unit, double weight,
                      std::vector<Eigen::Vector3d>* gradient);

}  // namespace simwright::asset_lift
