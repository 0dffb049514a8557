#pragma once

#include <Eigen/Core>

#include "core/mesh.h"
#include "geometry/isosurface.h"

namespace simwright::capture {

// The signed distance to a closed surface, sampled on a grid: cheap to look up.
class DistanceGrid {
 public:
  // `cells`: along the longest side of the surface; the grid exceeds the surface by a quarter of
  // its diagonal. Throws core::Error for a mesh without volume.
  DistanceGrid(const core::TriangleMesh& surface, int cells);

  // Returns the distance, m, negative inside; `gradient` (may be null): its derivative. Beyond the
  // grid, the distance to the grid is added.
  double At(const Eigen::Vector3d& point, Eigen::Vector3d* gradient = nullptr) const;
  double cell() const { return grid_.cell; }

 private:
  geometry::ScalarGrid grid_;
};

}  // namespace simwright::capture
