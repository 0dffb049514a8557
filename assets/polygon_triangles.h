#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::assets {

// Triangulates a simple, nearly planar polygon in space, preserving its orientation, by ear
// clipping in the plane of its Newell normal. Falls back to a fan if no ear is left (a
// self-intersecting polygon) or for more than 2000 corners.
std::vector<Eigen::Vector3i> PolygonTriangles(const std::vector<Eigen::Vector3d>& corners);

}  // namespace simwright::assets
