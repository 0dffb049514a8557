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

// Nearest neighbours among fixed points: a balanced k-d tree in the points' own order of storage.
class PointTree {
 public:
  explicit PointTree(std::vector<Eigen::Vector3d> points);
  // The point nearest to `p`. Requires at least one.
  const Eigen::Vector3d& Nearest(const Eigen::Vector3d& p) const;

 private:
  void Split(size_t first, size_t last);
  void Search(size_t first, size_t last, const Eigen::Vector3d& p, double* squared,
              size_t* best) const;

  std::vector<Eigen::Vector3d> points_;  // the median of each range splits it
  std::vector<std::uint8_t> axes_;       // along which a median splits
};

// A surface made ready to be compared: its bounding box's middle at the origin, the box's longest
// side 2, so that it spans [-1, 1] along it.
class ComparableShape {
 public:
  // Throws core::Error for an invalid mesh or one without extent.
  ComparableShape(const core::TriangleMesh& mesh, std::uint64_t seed);

  const Eigen::Affine3d& normal_from_mesh() const { return normal_from_mesh_; }
  const core::TriangleMesh& mesh() const { return mesh_; }  // normalised
  // Of the outer surface, which a ray from outside meets, each piece as often as it is met:
  // catalogue pieces have inner walls that no photo tells of. Random order. Normalised.
  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  // Of the first 8000 points.
  const PointTree& tree() const { return *tree_; }
  const geometry::TriangleTree& surface() const { return *surface_; }
  // What it fills, 96 cells along the longest side.
  const geometry::VoxelSolid& solid() const { return *solid_; }

 private:
  core::TriangleMesh mesh_;
  Eigen::Affine3d normal_from_mesh_;
  std::vector<Eigen::Vector3d> points_;
  std::unique_ptr<PointTree> tree_;
  std::unique_ptr<geometry::TriangleTree> surface_;
  std::unique_ptr<geometry::VoxelSolid> solid_;
};

// The similarity truth_from_other, between normalised frames, of the least Chamfer distance: from
// each of 36 turns about the vertical times 13 tilts (none; 12 and 24 degrees to six sides) of
// `other`, normalised to its box anew; the eight best are refined (AlignFrom) and the best is kept.
// Deterministic.
Eigen::Affine3d Align(const ComparableShape& truth, const ComparableShape& other);

// The similarity near a known rotation: iterated closest points in both directions, with scale
// (Besl and McKay 1992; scale by Horn 1987, symmetric in both shapes), of which the step of the
// least Chamfer distance is kept.
Eigen::Affine3d AlignFrom(const ComparableShape& truth, const ComparableShape& other,
                          const Eigen::Matrix3d& truth_from_other);

// How far a shape is from a body of revolution about its vertical middle: the largest Chamfer
// distance, in the normalised frame, to itself turned by angles that no regular prism repeats at.
// A cylinder has 0, a box about 0.1. Its axis is the box's middle or the centroid, whichever is
// better.
double TurningDefect(const ComparableShape& shape);

}  // namespace simwright::bench
