#pragma once

#include <vector>

#include "core/mesh.h"
#include "geometry/surface_distance.h"

namespace simwright::geometry {

// Lengths are in the mesh's own unit.
struct SurfaceWrapOptions {
  double cell = 0.0;     // edge of a grid cell, > 0
  double closing = 0.0;  // holes and gaps narrower than twice this are closed in the first step
  int growth_steps = 2;  // cells by which the outside region then grows through gaps
  // Surface points that are visible from outside. Where the outside region misses one, it grows
  // without limit, and slits that are still too narrow for the grid are carved open along the lines
  // of sight. If empty, growth stops after `growth_steps`.
  std::vector<OuterHit> visible_hits;
  // The lines of sight of visible points farther than this from the surface are carved out of the
  // walls too. 0: walls are not carved.
  double reach = 0.0;
  double wall = 0.0;  // thickness given to sheets and to parts too thin for the grid
};

struct SurfaceWrap {
  core::TriangleMesh mesh;   // from ExtractIsosurface, without inner bubbles
  double sheet_share = 0.0;  // share of the nodes at the surface that are next to a sheet
};

// Extracts the surface between the region that is reached from outside and the rest, on a grid
// around the triangles:
//  1. Distances to the triangles in a narrow band, and grid edges that cross a triangle.
//  2. The outside region: nodes farther than `closing` from the surface that are connected to the
//     border, then grown by `growth_steps` cells through edges that cross no triangle. Cracks into
//     which no ray sees stay closed, while crevices with visible walls are followed to their end.
//  3. The field is the distance, negative where not outside; around triangles with the outside on
//     both sides, and around parts thinner than a cell, it is the distance minus half the wall.
// Deterministic, whatever the thread count. The mesh must fit the grid's index range.
SurfaceWrap WrapSurface(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options);

// Returns the number of grid nodes that WrapSurface would use.
double WrapGridNodes(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options);

}  // namespace simwright::geometry
