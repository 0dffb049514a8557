#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// How often the given triangles of the mesh wind round the point: solid angles summed (van Oosterom
// and Strackee 1983) over 4 pi. A whole number for a closed oriented surface, in between for an
// open one; 1 inside a surface that faces outward.
double WindingNumber(const Eigen::Vector3d& point, const core::TriangleMesh& mesh,
                     const std::vector<int>& triangles);

// For each closed component (as numbered by EdgeComponents), how often the OTHER closed components
// wind round it: 0 for one in the open. Components must not cross each other. (component count)
std::vector<int> EnclosingWinding(const core::TriangleMesh& mesh, const std::vector<int>& component,
                                  int count);

}  // namespace simwright::geometry
