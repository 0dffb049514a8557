#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

// Vertices within `tolerance` (metres; 0: equal bit for bit) become one, unused ones go, and so do
// triangles that repeat a vertex or repeat another triangle's three (either way round).
core::TriangleMesh Weld(const core::TriangleMesh& mesh, double tolerance);

// The same triangles; vertices that none of them uses go.
core::TriangleMesh WithoutUnusedVertices(const core::TriangleMesh& mesh);

// A triangle at an edge.
struct EdgeUse {
  std::uint64_t key;  // (lower vertex << 32) | higher vertex
  int triangle;
  bool forward;  // from the lower vertex to the higher
};

// Every use of every edge (3M), by key, then by triangle.
std::vector<EdgeUse> SortedEdgeUses(const core::TriangleMesh& mesh);

// The number of each triangle's component, connected through shared edges; components are
// numbered by their first triangle. (M). `count` receives how many.
std::vector<int> EdgeComponents(const core::TriangleMesh& mesh, int* count);

// Faces turned so that neighbours across two-faced edges agree, as far as that can be; each closed
// component then faces outward. Returns whether all neighbours agree.
bool OrientConsistently(core::TriangleMesh* mesh);

// m^3, by the divergence theorem.
double SignedVolume(const core::TriangleMesh& mesh);

}  // namespace simwright::geometry
