#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

struct DecompositionOptions {
  double threshold = 0.05;  // largest concavity at which a piece is not cut, in CoACD's units: the
                            // solid's longest side counts 2. CoACD's default too; lower values give
                            // more parts
  int max_parts = 0;        // 0: as many as the threshold requires, at most 256
  int max_hull_vertices = 64;   // Bullet slows down and MuJoCo warns above
  int candidates = 12;          // cut positions tried per axis, in addition to the piece's features
  int beam = 6;                 // best cuts kept for the lookahead
  int depth = 2;                // cuts to look ahead; 1 is greedy
  bool principal_axes = true;   // also cut across the piece's own principal axes
  bool merge = true;            // merge neighbours while their common hull meets the threshold
  double min_thickness = 1e-3;  // of the diagonal: a flatter part is thickened or merged
  std::uint64_t seed = 1;       // for the sample points at which concavity is measured
};

struct ConvexPart {
  core::TriangleMesh hull;  // closed, convex, outward, at most max_hull_vertices vertices
  double concavity = 0.0;   // of the approximated piece of the solid, in CoACD's units
};

struct ConvexDecomposition {
  std::vector<ConvexPart> parts;  // by descending volume
  double concavity = 0.0;         // the largest of the parts' concavities, in CoACD's units
  double coverage = 0.0;          // share of the solid's surface in or near some part
};

// Decomposes `solid` (closed and oriented outward, preferably without self-intersections) into
// convex parts that cover it and leave its hollows open, in the manner of CoACD (Wei et al. 2022).
// A piece whose concavity max(Hausdorff distance to its hull, 0.3 Rv) exceeds the threshold is cut
// by the best plane of a short tree search; disconnected pieces are separated; finally neighbours
// are merged while the concavity stays below the threshold. The result depends on the seed only,
// not on the thread count. Throws core::Error for an invalid or empty mesh, one without volume, or
// options out of range; core::Cancelled after Ctrl-C.
ConvexDecomposition Decompose(const core::TriangleMesh& solid,
                              const DecompositionOptions& options = {});

// Returns only the hulls.
std::vector<core::TriangleMesh> Hulls(const ConvexDecomposition& decomposition);

}  // namespace simwright::geometry
