#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// A convex body: the hull of `vertices` (m, at least one), inflated by `radius` (m, >= 0). One
// vertex with a radius is a sphere, two are a capsule.
struct ConvexShape {
  std::vector<Eigen::Vector3d> vertices;
  double radius = 0.0;
};

struct ConvexDistance {
  double distance = 0.0;                              // m; negative: penetration depth
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, from a towards b, world frame
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero();  // witness on a's surface, world frame
  Eigen::Vector3d point_b = Eigen::Vector3d::Zero();  // point_b = point_a + distance * normal
};

// Returns the signed distance of two convex bodies: moving b by -distance * normal makes them just
// touch. Separated bodies: Gilbert, Johnson, Keerthi 1988. Interpenetrating bodies: the expanding
// polytope algorithm (van den Bergen 2001) on their Minkowski difference. Accurate to about 1e-9 of
// their size. The gradient of the distance with respect to a motion of b's points is `normal`.
// Throws core::Error for a body without vertices or coordinates that are not finite.
ConvexDistance SignedDistance(const ConvexShape& a, const Eigen::Isometry3d& world_from_a,
                              const ConvexShape& b, const Eigen::Isometry3d& world_from_b);

// Computes the same for two shapes given in one frame.
ConvexDistance SignedDistance(const ConvexShape& a, const ConvexShape& b);

// Returns true if two bodies, given in one frame, are farther apart than `margin` (m, >= 0). Ends
// as soon as a separating plane or a pair of near points is known, and allocates no memory. The
// bodies must have finite vertices, at least one each.
bool AreApart(const ConvexShape& a, const ConvexShape& b, double margin);

// Returns the smallest signed distance of `body` to any of `parts` (convex meshes, same frame),
// with the normal from the part to the body; `part` receives its index. Throws core::Error if there
// are no parts.
ConvexDistance SignedDistanceToParts(const std::vector<core::TriangleMesh>& parts,
                                     const ConvexShape& body, int* part = nullptr);

}  // namespace simwright::geometry
