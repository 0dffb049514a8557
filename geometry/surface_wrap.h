#pragma once

#include <vector>

#include "core/mesh.h"
#include "geometry/surface_distance.h"

namespace simwright::geometry {

// All lengths in the mesh's own unit.
struct SurfaceWrapOptions {
  double cell = 0.0;     // edge of a grid cell, > 0
  double closing = 0.0;  // holes and gaps narrower than twice this are not entered from afar
  int creep_steps = 2;   // cells that the outside then creeps through gaps
  // Points of the surface that are seen from outside. Where one of them is not met, the outside
  // creeps on without limit, and slits that are still too narrow for the grid are carved open along
  // the lines of sight. Empty: it stops after `creep_steps`.
  std::vector<OuterHit> seen;
  // Seen points farther than this from the surface get their line of sight carved out of the walls
  // too. 0: the walls stay whole.
  double reach = 0.0;
  double wall = 0.0;  // thickness given to sheets, and to parts too thin for the grid
};

struct SurfaceWrap {
  core::TriangleMesh mesh;   // as ExtractIsosurface gives it, without inner bubbles
  double sheet_share = 0.0;  // share of the nodes at the surface that saw a sheet
};

// The surface between what is reached from outside and the rest, on a grid round the triangles:
//  1. distance to the triangles in a narrow band; grid edges that cross a triangle;
//  2. outside: what is connected to the border through nodes farther than `closing` from the
//     surface, then `creep_steps` cells on through edges that cross no triangle; cracks that nobody
//     sees into stay closed so, while crevices with visible walls are followed to their end;
//  3. the field is the distance, negative where not outside; round triangles with the outside on
//     both sides, and round parts thinner than a cell, it is the distance less half the wall.
// Deterministic, whatever the threads. The mesh must fit the grid's index range.
SurfaceWrap WrapSurface(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options);

// Nodes of the grid that WrapSurface would use.
double WrapGridNodes(const core::TriangleMesh& mesh, const SurfaceWrapOptions& options);

}  // namespace simwright::geometry
