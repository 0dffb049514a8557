#pragma once

#include "core/finding.h"
#include "core/mesh.h"

namespace simwright::geometry {

// The method by which a solid was made, from the least change to the most.
enum class SolidMethod {
  kAsItIs,    // the visual mesh was already a solid after welding and reorienting faces
  kRepaired,  // duplicates or inner shells dropped, cracks stitched or small holes filled
  kWrapped,   // a surface extracted around it on a grid
};

const char* Name(SolidMethod method);  // "as it is", "repaired", "wrapped"

struct SolidOptions {
  // The face budget of a wrapped solid; an unchanged one may have up to ten times as many. 20k keep
  // the mass integrals, the convex decomposition and Bullet's loading within seconds.
  int face_budget = 20000;
  // The largest distance between the solid and the visual mesh's outer surface, in both directions,
  // as a share of the AABB's diagonal: the design's acceptance criterion.
  double tolerance_ratio = 0.005;
  // The wall thickness given to a sheet, as a share of the diagonal. Each side moves by half of it,
  // so it must stay well under twice the tolerance; it must also exceed sqrt(3) cells to have no
  // holes.
  double sheet_thickness_ratio = 0.005;
  // The edge of a grid cell, as a share of the diagonal: two cells span the tolerance.
  double cell_ratio = 0.0025;
  // The largest number of grid nodes; the cell grows until it fits. 60M nodes take about 0.6 GiB.
  double max_nodes = 60e6;
};

struct Solid {
  core::TriangleMesh mesh;  // closed, oriented outward, 2-manifold, free of self-intersections
  SolidMethod method = SolidMethod::kAsItIs;
  double sheet_thickness = 0.0;  // m, wall thickness given to sheets; 0 if there were none
  core::Findings findings;       // what was dropped, filled and thickened
};

// Makes one closed solid from any triangles: soups, open, inverted, doubled, nested, intersecting.
// The solid lies within `tolerance_ratio` of the outer surface (what a ray from outside can hit) in
// both directions; inner shells are dropped, thin open sheets get a wall. Deterministic, whatever
// the thread count. Throws core::Error if there are no faces, a coordinate is not finite, the mesh
// has no extent, or an index is out of range; core::Cancelled.
Solid MakeSolid(const core::TriangleMesh& visual, const SolidOptions& options = {});

}  // namespace simwright::geometry
