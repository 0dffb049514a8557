#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::geometry {

// Corners of the hull of `points`, counter-clockwise, without collinear ones (Andrew's monotone
// chain). Fewer than three where the points lie on a line.
std::vector<Eigen::Vector2d> PlaneHull(std::vector<Eigen::Vector2d> points);

// `polygon` (convex, in order) without the corners whose loss costs the least area, one by one:
// until `most` are left (>= 3), and on while the whole loss stays within `share` of the area.
std::vector<Eigen::Vector2d> FewerCorners(std::vector<Eigen::Vector2d> polygon, int most,
                                          double share);

}  // namespace simwright::geometry
