#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

struct ConcavityOptions {
  int surface_samples = 20000;  // points on each surface: Hausdorff noise below 1% of the diagonal
  int volume_samples = 100000;  // Monte Carlo points in the bounds: 1 sigma of 0.3% of the box
  double coverage_tolerance = 1e-3;  // of the diagonal: a point that near to a part is covered,
                                     // and a crack between parts that narrow is closed
  std::uint64_t seed = 1;
};

// How well convex parts stand for a solid. Lengths are relative to the diagonal of the solid's
// bounding box, volumes to the solid's volume.
struct DecompositionQuality {
  double concavity = 0.0;       // the larger of the two distances below
  double solid_to_parts = 0.0;  // largest distance of a point on the solid to the union's surface
  double uncovered = 0.0;  // largest distance of a point on the solid to the union: 0 inside it
  double parts_to_solid = 0.0;  // largest distance of a point on the union's surface to the solid
  double mean_parts_to_solid = 0.0;
  double volume_error = 0.0;    // volume of the symmetric difference
  double excess_volume = 0.0;   // of the parts outside the solid
  double missing_volume = 0.0;  // of the solid outside all parts
  double coverage = 0.0;        // share of points on the solid inside or near some part
};

// One measure for any decomposition, ours or another's. `solid` closed and outward, `parts`
// closed, convex and outward. The union's surface is what of the parts' surfaces lies inside no
// other part. Deterministic for a seed, whatever the thread count.
// Throws core::Error for invalid or empty meshes, or no parts.
DecompositionQuality MeasureDecomposition(const core::TriangleMesh& solid,
                                          const std::vector<core::TriangleMesh>& parts,
                                          const ConcavityOptions& options = {});

// Share of points sampled on the solid's surface that lie inside some part or within
// options.coverage_tolerance of one. In [0, 1]. Throws as MeasureDecomposition.
double Coverage(const core::TriangleMesh& solid, const std::vector<core::TriangleMesh>& parts,
                const ConcavityOptions& options = {});

// Largest distance (m) from a point sampled on the hull's surface to `mesh`'s, and back: the
// boundary concavity Hb of X. Wei et al., "Approximate convex decomposition for 3D meshes with
// collision-aware concavity and tree search", 2022. Throws for invalid or empty meshes.
double HausdorffToHull(const core::TriangleMesh& mesh, const core::TriangleMesh& hull,
                       int samples = 3000, std::uint64_t seed = 1);

// Their whole concavity (m): max(HausdorffToHull, 0.3 cbrt(3 (Vol(hull) - Vol(mesh)) / (4 pi))).
double Concavity(const core::TriangleMesh& mesh, const core::TriangleMesh& hull, int samples = 3000,
                 std::uint64_t seed = 1);

}  // namespace simwright::geometry
