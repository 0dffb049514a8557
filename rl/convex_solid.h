#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "sim/articulated_body.h"

namespace simwright::rl {

// A convex part of a thing, as points are looked up in it. Link frame, m.
struct ConvexSolid {
  // `mesh`: convex and closed, its faces look outwards.
  explicit ConvexSolid(const core::TriangleMesh& mesh);

  // m from `point` to the nearest face; 0 outside.
  double DepthOf(const Eigen::Vector3d& point) const;

  Eigen::AlignedBox3d box;
  std::vector<Eigen::Hyperplane<double, 3>> faces;  // each plane once
};

// By link of a body, the solids of its parts.
using BodySolids = std::vector<std::vector<ConvexSolid>>;

BodySolids SolidsOf(const sim::ArticulatedBody& body);

// Points on a surface and a sphere about them, m: what the sphere is clear of, the points are.
struct SurfacePoints {
  SurfacePoints() = default;
  explicit SurfacePoints(std::vector<Eigen::Vector3d> given);

  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

// How deep (m) the deepest of `surface` lies in `solid`, whose link sees it at `link_from_surface`.
double DeepestIn(const ConvexSolid& solid, const SurfacePoints& surface,
                 const Eigen::Isometry3d& link_from_surface);

}  // namespace simwright::rl
