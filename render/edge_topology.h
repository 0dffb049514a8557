#pragma once

#include <vector>

#include "render/differentiable.h"

namespace simwright::render {

// A mesh's edge. `a` and `b` are vertices of its first face, in the order of welded indices.
struct MeshEdge {
  int a = 0, b = 0;
  int first = 0, count = 0;  // its faces in EdgeTopology::faces; one: a border edge
  bool crease = false;       // colour or normal is discontinuous here though both faces are seen
};

// A face at an edge; `forward` is true if its corners run from `a` to `b`.
struct EdgeFace {
  int triangle = 0;
  bool forward = true;
};

// Adjacency by position: vertices at the same point count as one.
struct EdgeTopology {
  std::vector<int> welded;                        // (N) the first vertex at the same point
  std::vector<Eigen::Vector3i> welded_triangles;  // (M x 3) indices of welded vertices
  std::vector<MeshEdge> edges;                    // sorted by ends, ascending
  std::vector<EdgeFace> faces;                    // of all edges
  bool closed = false;                            // there is no border edge
};

// Finds the edges. `flat_shading`: normals are discontinuous at each edge (flat shading), so each
// is a crease. Otherwise creases are edges whose two faces have different vertex colours or texture
// coordinates there. Edges between welded corners of one face (no length) are left out.
EdgeTopology FindEdges(const DifferentiableObject& object, bool flat_shading);

}  // namespace simwright::render
