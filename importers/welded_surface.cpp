#include "importers/welded_surface.h"

#include <algorithm>
#include <numeric>

namespace simwright::importers {
namespace {

std::size_t CountOpenEdges(const core::TriangleMesh& mesh) {
  const std::vector<geometry::EdgeUse> uses = geometry::SortedEdgeUses(mesh);
  std::size_t open = 0;
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    open += end - i == 1;
    i = end;
  }
  return open;
}

int PieceRoot(std::vector<int>* parent, int x) {
  while ((*parent)[x] != x) x = (*parent)[x] = (*parent)[(*parent)[x]];
  return x;
}

}  // namespace

geometry::WeldedMesh WeldedSurface(const core::TriangleMesh& mesh) {
  const double diagonal = core::Bounds(mesh).diagonal().norm();
  geometry::WeldedMesh best = geometry::WeldWithOrigin(mesh, 0.0);
  std::size_t open = CountOpenEdges(best.mesh);
  for (const double tolerance : {1e-6, 1e-5, 1e-4}) {
    if (open == 0) break;
    geometry::WeldedMesh next = geometry::WeldWithOrigin(mesh, tolerance * diagonal);
    const std::size_t left = CountOpenEdges(next.mesh);
    // Coarser welding is only worth its changes where it closes many edges.
    if (2 * left > open) continue;
    open = left;
    best = std::move(next);
  }
  return best;
}

std::vector<SurfacePiece> DescribePieces(const core::TriangleMesh& mesh,
                                         const std::vector<int>& piece, int count) {
  std::vector<SurfacePiece> pieces(static_cast<std::size_t>(count));
  for (std::size_t t = 0; t < piece.size(); ++t) {
    SurfacePiece& one = pieces[static_cast<std::size_t>(piece[t])];
    ++one.faces;
    one.area += 0.5 * core::TriangleAreaVector(mesh, static_cast<int>(t)).norm();
    for (int k = 0; k < 3; ++k) one.box.extend(mesh.vertices[mesh.triangles[t][k]]);
  }
  const std::vector<geometry::EdgeUse> uses = geometry::SortedEdgeUses(mesh);
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    for (std::size_t u = i; u < end; ++u) {
      SurfacePiece& one = pieces[static_cast<std::size_t>(piece[uses[u].triangle])];
      one.open_edges += end - i == 1;
      one.shared_edges += end - i > 2;
    }
    i = end;
  }
  return pieces;
}

std::vector<int> ManifoldPieces(const core::TriangleMesh& mesh, int* count) {
  const std::vector<geometry::EdgeUse> uses = geometry::SortedEdgeUses(mesh);
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    if (end - i == 2) {
      const int a = PieceRoot(&parent, uses[i].triangle);
      const int b = PieceRoot(&parent, uses[i + 1].triangle);
      parent[std::max(a, b)] = std::min(a, b);
    }
    i = end;
  }
  std::vector<int> piece(parent.size());
  *count = 0;
  for (std::size_t t = 0; t < parent.size(); ++t) {
    const int root = PieceRoot(&parent, static_cast<int>(t));
    piece[t] = root == static_cast<int>(t) ? (*count)++ : piece[root];
  }
  return piece;
}

}  // namespace simwright::importers
