#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

// What a mesh fills, on a regular grid: good to a cell, for any triangles, in a fraction of the
// time that a clean solid takes. Const and safe from several threads.
class VoxelSolid {
 public:
  // `resolution`: cells along the mesh's longest side, 8 to 512. A node is outside where it can be
  // reached from the border without crossing a triangle; sheets (and all that is thinner than a
  // cell) are given a thickness of `sheet_cells`; everything then grows by `growth_cells` (at most
  // 1). Throws core::Error for an invalid mesh, one without extent, or a resolution out of range.
  VoxelSolid(const core::TriangleMesh& mesh, int resolution, double sheet_cells = 1.5,
             double growth_cells = 0.0);

  // Share in [0, 1] of a cell about `point` that is filled: a ramp one cell wide across the
  // surface, trilinear between nodes.
  float Occupancy(const Eigen::Vector3d& point) const;

  double cell() const { return cell_; }
  // Volume that is filled, m^3.
  double Volume() const;

 private:
  float At(int i, int j, int k) const;

  Eigen::Vector3d origin_{0, 0, 0};
  double cell_ = 1.0;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  // Occupancy of the nodes, 255 full: all that a lookup needs, an eighth of the distances' size.
  std::vector<std::uint8_t> occupancy_;
};

}  // namespace simwright::geometry
