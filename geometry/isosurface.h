#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// Samples of a scalar field at the nodes of a regular grid. Node (i, j, k) is at origin + cell *
// (i, j, k).
struct ScalarGrid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // metres
  double cell = 1.0;                                 // metres, > 0
  int nx = 0, ny = 0, nz = 0;                        // nodes along x, y, z; >= 2 each
  std::vector<float> values;                         // nx * ny * nz, x fastest, then y, then z

  std::size_t Index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(nx) * (j + static_cast<std::size_t>(ny) * k);
  }
};

// Extracts the surface at which the field crosses `level`. Values BELOW `level` are inside (a
// signed distance, negative inside); pass the negated field for a density. Nodes on the grid's
// border count as outside whatever their value, so the surface always closes. Returns a closed,
// 2-manifold mesh without self-intersections, triangles counter-clockwise seen from outside, each
// vertex shared; empty if nothing is inside. Marching cubes (Lorensen and Cline 1987) on a field
// without ambiguous faces: where the four corners of a face alternate, the node nearest to the
// level changes side first. Each cube face then holds one segment at most, so fans over the
// polygons cannot intersect. Crossings keep 1% of an edge's length away from its ends, so no
// triangle is degenerate. NaN counts as outside. Throws core::Error if the sizes and the number of
// values disagree.
core::TriangleMesh ExtractIsosurface(const ScalarGrid& field, float level);

}  // namespace simwright::geometry
