#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::pipeline {

// At most `count` corners of the polygon on which `solid` stands at its lowest level: extreme
// vertices, by direction, of those within 0.1 % of its height of the lowest. Empty where it stands
// on a point.
std::vector<Eigen::Vector3d> FootCorners(const core::TriangleMesh& solid, int count);

}  // namespace simwright::pipeline
