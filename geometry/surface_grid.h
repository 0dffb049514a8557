#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// Triangles rasterised into a regular grid of nodes: the distance of each node near the surface,
// the nearest piece, and the grid edges that a triangle crosses.
class SurfaceGrid {
 public:
  // `band`: distances are exact up to this, and kFar beyond. `margin` cells on each side are empty.
  SurfaceGrid(const core::TriangleMesh& mesh, double cell, double band, int margin);

  static constexpr float kFar = 3.0e38f;

  // Returns the number of nodes along each axis for these arguments.
  static std::array<int, 3> Size(const core::TriangleMesh& mesh, double cell, double band,
                                 int margin);

  const std::array<int, 3>& size() const { return size_; }
  const std::array<std::size_t, 3>& stride() const { return stride_; }
  std::size_t count() const { return distance_.size(); }
  double cell() const { return cell_; }
  const Eigen::Vector3d& origin() const { return origin_; }

  float Distance(std::size_t node) const { return distance_[node]; }
  // Returns the surface point nearest to a node within the band.
  Eigen::Vector3d Nearest(std::size_t node) const;
  // Returns true if a triangle crosses the edge from `node` to the next node along `axis`.
  bool Crossed(std::size_t node, int axis) const { return (crossed_[node] >> axis) & 1; }
  Eigen::Vector3d Position(std::size_t node) const;

 private:
  struct Piece {
    Eigen::Vector3d a, b, c;
  };

  void Subdivide(const core::TriangleMesh& mesh);
  void EnterDistances(const Piece& piece, int index, int low_k, int high_k);
  void EnterCrossings(const Piece& piece, int low_k, int high_k);
  // Marks the crossings of the grid lines along `axis` with the piece.
  void EnterCrossingsAlong(int axis, const Piece& piece, const Eigen::Vector3d& normal, int low_k,
                           int high_k);

  double cell_;
  double band_;
  Eigen::Vector3d origin_;
  std::array<int, 3> size_;
  std::array<std::size_t, 3> stride_;
  std::vector<Piece> pieces_;  // triangles subdivided to a few cells; in cells from the origin
  std::vector<float> distance_;
  std::vector<int> nearest_;
  std::vector<std::uint8_t> crossed_;
};

}  // namespace simwright::geometry
