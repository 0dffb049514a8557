#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/mesh.h"

namespace simwright::geometry {

// Samples of a scalar field at the nodes of a regular grid. Node (i, j, k) stands at
// origin + cell * (i, j, k).
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

// The surface where the field crosses `level`. Inside is where values lie BELOW `level` (a signed
// distance, negative inside); pass the negated field for a density. Nodes on the grid's border
// count as outside whatever their value, so the surface always closes.
// Returns a closed, 2-manifold mesh without self-intersections, triangles counter-clockwise seen
// from outside, each vertex shared; empty where nothing lies inside. Marching cubes (Lorensen and
// Cline 1987) on a field without ambiguous faces: where the four corners of a face alternate, the
// node nearest to the level changes side first. Then each cube's face holds one segment at most, so
// fans over the polygons cannot cross. Crossings keep off an edge's ends by 1% of its length, so
// no triangle is degenerate.
// NaN counts as outside. Throws core::Error where the sizes and the values do not fit together.
core::TriangleMesh ExtractIsosurface(const ScalarGrid& field, float level);

}  // namespace simwright::geometry
