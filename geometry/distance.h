#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// A convex body: the hull of `vertices` (m, at least one), grown by `radius` (m, >= 0) all round.
// One vertex with a radius is a ball, two are a capsule.
struct ConvexShape {
  std::vector<Eigen::Vector3d> vertices;
  double radius = 0.0;
};

struct ConvexDistance {
  double distance = 0.0;  // m; negative: depth of the shallowest way out
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, from a towards b, world frame
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero();  // witness on a's surface, world frame
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  // point_b = point_a + distance * normal
};

// Signed distance of two convex bodies: moving b by -distance * normal makes them just touch.
// Apart: Gilbert, Johnson, Keerthi 1988. Overlapping: the expanding polytope (van den Bergen
// 2001) on their Minkowski difference. Accurate to about 1e-9 of their size.
// The gradient of the distance with respect to a motion of b's points is `normal`.
// Throws core::Error for a body without vertices or coordinates that are not finite.
ConvexDistance SignedDistance(const ConvexShape& a, const Eigen::Isometry3d& world_from_a,
                              const ConvexShape& b, const Eigen::Isometry3d& world_from_b);

// The same, both given in one frame.
ConvexDistance SignedDistance(const ConvexShape& a, const ConvexShape& b);

// The least signed distance of `body` to any of `parts` (convex meshes, same frame), with its
// normal from the part to the body; `part` is its index. Throws core::Error when there are none.
ConvexDistance SignedDistanceToParts(const std::vector<core::TriangleMesh>& parts,
                                     const ConvexShape& body, int* part = nullptr);

}  // namespace simwright::geometry
