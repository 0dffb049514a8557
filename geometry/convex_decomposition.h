#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

struct DecompositionOptions {
  double threshold = 0.05;  // concavity at which a piece is left alone, in the units of CoACD: the
                            // solid's longest side counts 2. Theirs too; lower means more parts
  int max_parts = 0;        // 0: as many as the threshold asks for, at most 256
  int max_hull_vertices = 64;  // Bullet slows down and MuJoCo warns above
  int candidates = 12;  // cut positions tried per axis, besides those at the piece's features
  int beam = 6;         // best cuts kept for the look ahead
  int depth = 2;        // cuts looked ahead; 1 is greedy
  bool principal_axes = true;   // also cut across the piece's own principal axes
  bool merge = true;            // join neighbours while their common hull meets the threshold
  double min_thickness = 1e-3;  // of the diagonal: a flatter part is thickened or merged
  std::uint64_t seed = 1;       // of the points that the concavity is measured at
};

struct ConvexPart {
  core::TriangleMesh hull;  // closed, convex, outward, at most max_hull_vertices vertices
  double concavity = 0.0;   // of the piece of the solid that it stands for, in CoACD's units
};

struct ConvexDecomposition {
  std::vector<ConvexPart> parts;  // by falling volume
  double concavity = 0.0;         // the largest of the parts', in CoACD's units
  double coverage = 0.0;          // share of the solid's surface inside or near some part
};

// Convex parts that cover `solid` (a closed, outward surface, best without self-intersections) and
// leave its hollows open, in the manner of CoACD (Wei et al. 2022): a piece whose concavity
// max(Hausdorff distance to its hull, 0.3 Rv) lies above the threshold is cut by the plane that a
// short tree search finds best; pieces that fall apart are taken apart; at last neighbours are
// merged where that keeps the concavity below the threshold.
// The same result for a seed, whatever the thread count. Throws core::Error for an invalid or
// empty mesh, one without volume, or options out of range; core::Cancelled after Ctrl-C.
ConvexDecomposition Decompose(const core::TriangleMesh& solid,
                              const DecompositionOptions& options = {});

// The hulls alone.
std::vector<core::TriangleMesh> Hulls(const ConvexDecomposition& decomposition);

}  // namespace simwright::geometry
