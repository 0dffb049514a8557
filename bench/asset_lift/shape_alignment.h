#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"
#include "geometry/triangle_tree.h"
#include "geometry/voxel_solid.h"

namespace simwright::bench {

// A balanced k-d tree over fixed points, stored in the points' own order.
class PointTree {
 public:
  explicit PointTree(std::vector<Eigen::Vector3d> points);
  // Returns the point nearest to `p`. Requires at least one.
  const Eigen::Vector3d& Nearest(const Eigen::Vector3d& p) const;

 private:
  void Split(size_t first, size_t last);
  void Search(size_t first, size_t last, const Eigen::Vector3d& p, double* squared,
              size_t* best) const;

  std::vector<Eigen::Vector3d> points_;  // the median of each range splits it
  std::vector<std::uint8_t> axes_;       // split axis of each median
};

// A surface prepared for comparison: its bounding box is centered at the origin, with a longest
// side of 2 that spans [-1, 1].
class ComparableShape {
 public:
  // Throws core::Error for an invalid mesh or one without extent.
  ComparableShape(const core::TriangleMesh& mesh, std::uint64_t seed);

  const Eigen::Affine3d& normal_from_mesh() const { return normal_from_mesh_; }
  const core::TriangleMesh& mesh() const { return mesh_; }  // normalised
  // Returns points of the outer surface, which a ray from outside hits, each region as often as it
  // is hit: catalogue objects have inner walls that no photo shows. Random order. Normalized.
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  // Returns the tree of the first 8000 points.
  const PointTree& tree() const { return *tree_; }
  const geometry::TriangleTree& surface() const { return *surface_; }
  // Returns the filled solid, 96 cells along the longest side.
  const geometry::VoxelSolid& solid() const { return *solid_; }

 private:
  core::TriangleMesh mesh_;
  Eigen::Affine3d normal_from_mesh_;
  std::vector<Eigen::Vector3d> points_;
  std::unique_ptr<PointTree> tree_;
  std::unique_ptr<geometry::TriangleTree> surface_;
  std::unique_ptr<geometry::VoxelSolid> solid_;
};

// Returns the similarity truth_from_other, between normalized frames, of the smallest Chamfer
// distance: from each of 36 rotations about the vertical times 13 tilts (none; 12 and 24 degrees in
// six directions) of `other`, each normalized to its own box; the eight best are refined
// (AlignFrom) and the best is kept. Deterministic.
Eigen::Affine3d Align(const ComparableShape& truth, const ComparableShape& other);

// Returns the similarity near a known rotation: iterated closest points in both directions, with
// scale (Besl and McKay 1992; scale by Horn 1987, symmetric in both shapes), of which the step with
// the smallest Chamfer distance is kept.
Eigen::Affine3d AlignFrom(const ComparableShape& truth, const ComparableShape& other,
                          const Eigen::Matrix3d& truth_from_other);

// Returns the distance of a shape from a solid of revolution about its vertical middle: the largest
// Chamfer distance, in the normalized frame, to itself rotated by angles at which no regular prism
// repeats. A cylinder has 0, a box about 0.1. Its axis is the box's middle or the centroid,
// whichever is better.
double TurningDefect(const ComparableShape& shape);

}  // namespace simwright::bench
