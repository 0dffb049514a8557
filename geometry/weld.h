#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// Merges vertices within `tolerance` (metres; 0: bit for bit equal) and removes unused vertices and
// triangles that repeat a vertex or another triangle's three (in either orientation).
core::TriangleMesh Weld(const core::TriangleMesh& mesh, double tolerance);

// The same, with the origin of its faces.
struct WeldedMesh {
  core::TriangleMesh mesh;
  // (faces of the input) the index of its face here; a repeated face has that of the one that was
  // kept, a face that repeats a vertex has -1.
  std::vector<int> face_of;
};
WeldedMesh WeldWithOrigin(const core::TriangleMesh& mesh, double tolerance);

// Returns the same triangles without the unused vertices.
core::TriangleMesh WithoutUnusedVertices(const core::TriangleMesh& mesh);

// A triangle at an edge.
struct EdgeUse {
  std::uint64_t key;  // (lower vertex << 32) | higher vertex
  int triangle;
  bool forward;  // from the lower vertex to the higher
};

// Returns every use of every edge (3M), sorted by key, then by triangle.
std::vector<EdgeUse> SortedEdgeUses(const core::TriangleMesh& mesh);

// Returns the component of each triangle, connected through shared edges; components are numbered
// by their first triangle. (M). `count` receives their number.
std::vector<int> EdgeComponents(const core::TriangleMesh& mesh, int* count);

// Flips faces so that neighbours across two-faced edges agree, as far as possible; each closed
// component then faces outward. Returns true if all neighbours agree.
bool OrientConsistently(core::TriangleMesh* mesh);

// Returns the signed volume in m^3, by the divergence theorem.
double SignedVolume(const core::TriangleMesh& mesh);

}  // namespace simwright::geometry
