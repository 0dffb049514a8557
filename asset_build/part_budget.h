#pragma once

#include <string>

#include "core/finding.h"
#include "geometry/convex_decomposition.h"

namespace simwright::asset_build {

// The limits that a user states for collision parts. 0: no limit of the user's.
struct PartBudget {
  int max_parts = 0;       // of an asset, of each link of an articulated one
  int max_vertices = 0;    // of a part
  int max_faces = 0;       // of a part, triangles
  double tolerance = 0.0;  // m, the largest distance by which a part may deviate from the solid

  bool Any() const { return max_parts > 0 || max_vertices > 0 || max_faces > 0 || tolerance > 0.0; }
};

// The fewest vertices and triangles that a part may be limited to, and the most parts: the corners
// of a support face must fit beside the other vertices.
inline constexpr int kLeastVertices = 28, kLeastFaces = 52, kMostVertices = 256, kMostParts = 256;

// Throws core::Error for a limit that is out of range.
void Validate(const PartBudget& budget);

// Returns the most vertices of a part: the budget's, by its vertices and its faces, or 64.
int MostVertices(const PartBudget& budget);

// Returns `options` with the limits of `budget` in place of its own.
geometry::DecompositionOptions Limited(geometry::DecompositionOptions options,
                                       const PartBudget& budget);

// Appends the finding "part-budget", a warning, if the parts of `solid` are less precise than asked
// because of the budget's other limits. It states the deviation (the figure, m) and the number of
// parts that the tolerance (or, without one, the usual precision) would take. `done` is the
// decomposition by `options`, which Limited returned.
void ReportBinding(const core::TriangleMesh& solid, const geometry::DecompositionOptions& options,
                   const PartBudget& budget, const geometry::ConvexDecomposition& done,
                   const std::string& place, core::Findings* findings);

}  // namespace simwright::asset_build
