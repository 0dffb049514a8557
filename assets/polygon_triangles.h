#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::assets {

// A simple polygon in space, nearly flat, as triangles over its corners, turning the same way: ears
// are clipped in the plane of its Newell normal. A fan where no ear is left (it crosses itself) or
// of more than 2000 corners.
std::vector<Eigen::Vector3i> PolygonTriangles(const std::vector<Eigen::Vector3d>& corners);

}  // namespace simwright::assets
