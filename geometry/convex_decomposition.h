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
  double tolerance = 0.0;   // m, > 0: takes the threshold's place: the largest distance by which a
                            // part may deviate from the solid
  int max_hull_vertices = 64;   // >= 16; Bullet slows down and MuJoCo warns above
  int max_hull_faces = 0;       // triangles, >= 28; 0: as many as the vertices allow
  int candidates = 12;          // cut positions tried per axis, in addition to the piece's features
  int beam = 6;                 // best cuts kept for the lookahead
  int depth = 2;                // cuts to look ahead; 1 is greedy
  bool principal_axes = true;   // also cut across the piece's own principal axes
  bool merge = true;            // merge neighbours while their common hull meets the threshold
  double min_thickness = 1e-3;  // of the diagonal: a flatter part is thickened or merged
  std::uint64_t seed = 1;       // for the sample points at which concavity is measured
};

struct ConvexPart {
  core::TriangleMesh hull;  // closed, convex, outward, within the options' vertices and faces
  double concavity = 0.0;   // of the approximated piece of the solid, in CoACD's units
};

struct ConvexDecomposition {
  std::vector<ConvexPart> parts;  // by descending volume
  double concavity = 0.0;         // the largest of the parts' concavities, in CoACD's units
  // m, the largest distance of a point on a part's hull outside of the solid to the solid, of a
  // point on the solid inside a hull to that hull's surface, or of one outside of all hulls to
  // them.
  double deviation = 0.0;
  double coverage = 0.0;  // share of the solid's surface in or near some part
};

// Decomposes `solid` (closed and oriented outward, preferably without self-intersections) into
// convex parts that cover it and leave its hollows open, in the manner of CoACD (Wei et al. 2022).
// A piece whose concavity max(Hausdorff distance to its hull, 0.3 Rv) exceeds the threshold is cut
// by the best plane of a short tree search; disconnected pieces are separated; finally neighbours
// are merged while the concavity stays below the threshold, and the groups of pieces are improved
// at an equal number of parts. The result depends on the seed only, not on the thread count, and
// hardly on the rounding of coordinates. Throws core::Error for an invalid or empty mesh, one
// without volume, or options out of range; core::Cancelled after Ctrl-C.
ConvexDecomposition Decompose(const core::TriangleMesh& solid,
                              const DecompositionOptions& options = {});

// Returns only the hulls.
std::vector<core::TriangleMesh> Hulls(const ConvexDecomposition& decomposition);

// Merges convex parts (closed, oriented outward) to at most `max_parts`: repeatedly those two whose
// common hull adds the least volume, with at most `max_vertices` (>= 16) vertices. For parts of
// bodies that no single solid encloses. Throws core::Error for limits out of range.
std::vector<core::TriangleMesh> MergeHulls(std::vector<core::TriangleMesh> parts, int max_parts,
                                           int max_vertices);

}  // namespace simwright::geometry
