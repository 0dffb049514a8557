#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "sim/articulated_body.h"

namespace simwright::manipulation {

// A convex part of an object for point queries. Link frame, m.
struct ConvexPart {
  // `mesh`: convex and closed, with outward-facing faces.
  explicit ConvexPart(const core::TriangleMesh& mesh);

  // Returns the distance (m) from `point` to the nearest face; 0 outside.
  double DepthOf(const Eigen::Vector3d& point) const;

  Eigen::AlignedBox3d box;
  std::vector<Eigen::Hyperplane<double, 3>> faces;  // each plane once
};

// The convex parts of a body, by link.
using BodyParts = std::vector<std::vector<ConvexPart>>;

BodyParts ConvexPartsOf(const sim::ArticulatedBody& body);

// Points on a surface and their bounding sphere, m, for early rejection.
struct SurfacePoints {
  SurfacePoints() = default;
  explicit SurfacePoints(std::vector<Eigen::Vector3d> given);

  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// Returns the depth (m) of the deepest point of `surface` in `solid`. `link_from_surface`: the pose
// of the surface in the solid's link.
double PenetrationIntoPart(const ConvexPart& solid, const SurfacePoints& surface,
                           const Eigen::Isometry3d& link_from_surface);

}  // namespace simwright::manipulation
