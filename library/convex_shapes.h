#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::library {

// Closed, outward, convex meshes of at most 64 vertices: what a generator builds with. What is seen
// is also what collides and weighs. Metres.

// A box between two corners (in any order), its edges chamfered by `bevel` (at most a quarter of
// the shortest side; 0: sharp).
core::TriangleMesh Box(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double bevel = 0.002);

// A round bar from one point to another, its radius going from `first` to `last`.
core::TriangleMesh Frustum(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double first,
                           double last, int segments = 20);
core::TriangleMesh Rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                       int segments = 20);

// The hull of points.
core::TriangleMesh Hull(const std::vector<Eigen::Vector3d>& points);

// A round bar along a path, a piece a leg, mitred at the bends: neighbours share their end faces,
// so that volumes add. Bends must be gentler than a right angle by a little where legs are short.
std::vector<core::TriangleMesh> Pipe(const std::vector<Eigen::Vector3d>& path, double radius,
                                     int segments = 12);

// Points of an arc about `center` from `from`, turned by `angle` (rad) about `axis`. (steps + 1)
std::vector<Eigen::Vector3d> Arc(const Eigen::Vector3d& center, const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& axis, double angle, int steps);

}  // namespace simwright::library
