#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/mesh.h"

namespace simwright::geometry {

struct VoxelSolidOptions {
  int resolution = 80;  // cells along the mesh's longest side, 8 to 512
  // The thickness of sheets and of parts thinner than a cell.
  double sheet_cells = 1.5;
  double growth_cells = 0.0;  // growth of the filled region, [0, 1]
  // Regions behind openings narrower than twice this are filled: 0 to 16. Shells with cracks and
  // missing faces are meant as solids; a cup's mouth is wider.
  double gap_cells = 0.0;
  // The mesh stands on a floor (z up): regions reachable only through its open underside are
  // filled.
  bool on_floor = false;

  // Returns false, with the reason, for values out of range.
  bool IsValid(std::string* error) const;
};

// The volume filled by a mesh, on a regular grid: accurate to a cell, for any triangles, in a
// fraction of the time that MakeSolid takes. Const and thread-safe.
class VoxelSolid {
 public:
  // A node is outside if it can be reached from the border without crossing a triangle. Throws
  // core::Error for an invalid mesh, one without extent, or invalid options.
  VoxelSolid(const core::TriangleMesh& mesh, const VoxelSolidOptions& options);

  // Returns the filled share in [0, 1] of a cell about `point`: a ramp one cell wide across the
  // surface, trilinear between nodes.
  float Occupancy(const Eigen::Vector3d& point) const;

  double cell() const { return cell_; }
  // Returns the filled volume, m^3.
  double Volume() const;

 private:
  float At(int i, int j, int k) const;

  Eigen::Vector3d origin_{0, 0, 0};
  double cell_ = 1.0;
  int nx_ = 0, ny_ = 0, nz_ = 0;
  // Occupancy of the nodes, 255 for full: sufficient for lookups, an eighth of the distances' size.
  std::vector<std::uint8_t> occupancy_;
};

}  // namespace simwright::geometry
