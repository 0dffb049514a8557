#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::geometry {

// Returns the corners of the convex hull of `points`, counter-clockwise, without collinear ones
// (Andrew's monotone chain). Returns fewer than three if the points lie on a line.
std::vector<Eigen::Vector2d> ConvexHull2d(std::vector<Eigen::Vector2d> points);

// Simplifies `polygon` (convex, in order): removes one by one the corner that costs the least area,
// until `most` (>= 3) are left, and further while the total loss stays within `share` of the area.
std::vector<Eigen::Vector2d> SimplifyConvexPolygon(std::vector<Eigen::Vector2d> polygon, int most,
                                                   double share);

}  // namespace simwright::geometry
