#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::library {

// The closed, outward-oriented, convex meshes of at most 64 vertices from which generators build.
// The visual mesh is also the collision and mass geometry. Metres.

// Returns a box between two corners (in any order), its edges chamfered by `bevel` (at most a
// quarter of the shortest side; 0: sharp).
core::TriangleMesh Box(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double bevel = 0.002);

// Returns a round bar from one point to another, with a radius from `first` to `last`.
core::TriangleMesh Frustum(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double first,
                           double last, int segments = 20);
core::TriangleMesh Rod(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
                       int segments = 20);

// Returns the convex hull of points.
core::TriangleMesh Hull(const std::vector<Eigen::Vector3d>& points);

// Returns a round bar along a path, one piece per segment, mitred at the bends: neighbours share
// their end faces, so that volumes add. Bends must be slightly gentler than a right angle where
// segments are short.
std::vector<core::TriangleMesh> Pipe(const std::vector<Eigen::Vector3d>& path, double radius,
                                     int segments = 12);

// Returns the points of an arc about `center` from `from`, rotated by `angle` (rad) about `axis`.
// (steps + 1)
std::vector<Eigen::Vector3d> Arc(const Eigen::Vector3d& center, const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& axis, double angle, int steps);

}  // namespace simwright::library
