#pragma once

#include <vector>

#include "core/mesh.h"
#include "geometry/weld.h"

namespace simwright::importers {

// Returns the mesh welded with the smallest of a few tolerances that closes about as many of its
// edges as the largest: files of single triangles repeat vertices with rounding errors.
geometry::WeldedMesh WeldedSurface(const core::TriangleMesh& mesh);

// A set of connected faces.
struct SurfacePiece {
  int faces = 0;
  double area = 0.0;  // in the mesh's unit squared
  Eigen::AlignedBox3d box;
  int open_edges = 0;    // with one face
  int shared_edges = 0;  // of other pieces, with three faces or more
};

// Returns each piece of `mesh`, given the piece of each face.
std::vector<SurfacePiece> DescribePieces(const core::TriangleMesh& mesh,
                                         const std::vector<int>& piece, int count);

// Returns the piece of each face; unlike geometry::EdgeComponents, edges with three faces or more
// separate pieces.
std::vector<int> ManifoldPieces(const core::TriangleMesh& mesh, int* count);

}  // namespace simwright::importers
