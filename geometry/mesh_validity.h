#pragma once

#include <string>

#include "core/mesh.h"

namespace simwright::geometry {

// The criteria for a mesh to bound a solid.
struct MeshValidity {
  bool closed = false;         // each edge has as many faces in one direction as in the other
  bool oriented = false;       // neighbours agree, and each component that no other encloses faces
                               // outward
  bool manifold = false;       // each edge has two faces, each vertex one fan of faces
  int open_edges = 0;          // edges with one face
  int non_manifold_edges = 0;  // edges with three or more faces
  int non_manifold_vertices = 0;  // vertices with more than one fan
  int self_intersections = 0;     // pairs of faces that meet elsewhere than in shared vertices and
                                  // edges
  int components = 0;             // connected through edges
  int degenerate_triangles = 0;   // repeated vertex, or area zero in exact arithmetic
  double signed_volume = 0.0;     // m^3, by the divergence theorem; negative when inside out

  // Returns true if all criteria hold and the volume is positive: the mesh bounds a solid.
  bool IsSolid() const {
    return closed && oriented && manifold && self_intersections == 0 && degenerate_triangles == 0 &&
           signed_volume > 0.0;
  }
};

// Checks a mesh. Vertices are distinguished by index: weld first if a file repeats them.
// Self-intersections are decided with exact predicates; `self_intersections` stops counting at
// `intersection_limit`. 50k faces take under a second. Throws core::Error for an index out of range
// or a coordinate that is not finite.
MeshValidity Examine(const core::TriangleMesh& mesh, int intersection_limit = 1000);

// Formats one line for a person, e.g. "closed, oriented, 12 self-intersections, 3 components".
std::string Describe(const MeshValidity& validity);

}  // namespace simwright::geometry
