#pragma once

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::geometry {

// How a solid came about, from the least change to the most.
enum class SolidMethod {
  kAsItIs,    // the visual mesh was one already, after welding and turning faces round
  kRepaired,  // duplicates or inner shells dropped, cracks stitched or small holes filled
  kWrapped,   // a surface extracted round it on a grid
};

const char* Name(SolidMethod method);  // "as it is", "repaired", "wrapped"

struct SolidOptions {
  // Faces of a wrapped solid; what is as it is keeps its faces up to ten times this many. 20k keep
  // the mass integrals, the convex decomposition and Bullet's loading in seconds.
  int face_budget = 20000;
  // Farthest that the solid may lie from the visual mesh's outer surface, and back, as a share of
  // the bounding box's diagonal: the design's acceptance.
  double tolerance_ratio = 0.005;
  // Wall given to a sheet, as a share of the diagonal. Each side moves by half of it, so it has to
  // stay well under twice the tolerance; and it has to exceed sqrt(3) cells to have no holes.
  double sheet_thickness_ratio = 0.005;
  // Edge of a grid cell, as a share of the diagonal: two cells reach across the tolerance.
  double cell_ratio = 0.0025;
  // Nodes of the grid at most; the cell grows until it fits. 60M nodes are about 0.6 GiB.
  double max_nodes = 60e6;
};

struct Solid {
  core::TriangleMesh mesh;  // closed, oriented outward, 2-manifold, free of self-intersections
  SolidMethod method = SolidMethod::kAsItIs;
  double sheet_thickness = 0.0;  // m, the wall given to sheets; 0 where there were none
  core::Findings findings;       // what was dropped, filled, thickened, in words
};

// One closed solid from any triangles: soups, open, inverted, doubled, nested, crossing. Within
// `tolerance_ratio` of the outer surface (what a ray from outside can meet) in both directions;
// inner shells are dropped, thin open sheets get a wall. Deterministic, whatever the threads.
// Throws core::Error where there are no faces, a coordinate is not finite, the mesh has no extent,
// or an index is out of range; core::Cancelled.
Solid MakeSolid(const core::TriangleMesh& visual, const SolidOptions& options = {});

}  // namespace simwright::geometry
