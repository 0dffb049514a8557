#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"

namespace simwright::geometry {

struct ConcavityOptions {
  int surface_samples = 20000;  // points on each surface: Hausdorff noise below 1% of the diagonal
  int volume_samples = 100000;  // Monte Carlo points in the AABB: 1 sigma is 0.3% of its volume
  double coverage_tolerance = 1e-3;  // of the diagonal: a point within this distance of a part is
                                     // covered, and narrower cracks between parts are closed
  std::uint64_t seed = 1;
};

// The quality with which convex parts approximate a solid. Lengths are relative to the diagonal of
// the solid's AABB, volumes to the solid's volume.
struct DecompositionQuality {
  double concavity = 0.0;       // the larger of the two distances below
  double solid_to_parts = 0.0;  // largest distance of a point on the solid to the union's surface
  double uncovered = 0.0;  // largest distance of a point on the solid to the union; 0 inside it
  double parts_to_solid = 0.0;  // largest distance of a point on the union's surface to the solid
  double mean_parts_to_solid = 0.0;
  double volume_error = 0.0;    // volume of the symmetric difference
  double excess_volume = 0.0;   // of the parts outside the solid
  double missing_volume = 0.0;  // of the solid outside all parts
  double coverage = 0.0;        // share of points on the solid in or near some part
};

// Measures any decomposition, ours or another's. `solid` must be closed and oriented outward,
// `parts` closed, convex and oriented outward. The union's surface is the part of the parts'
// surfaces that lies inside no other part. Deterministic for a seed, whatever the thread count.
// Throws core::Error for invalid or empty meshes, or no parts.
DecompositionQuality MeasureDecomposition(const core::TriangleMesh& solid,
                                          const std::vector<core::TriangleMesh>& parts,
                                          const ConcavityOptions& options = {});

// Returns the share of points sampled on the solid's surface that lie inside some part or within
// options.coverage_tolerance of one, in [0, 1]. Throws like MeasureDecomposition.
double Coverage(const core::TriangleMesh& solid, const std::vector<core::TriangleMesh>& parts,
                const ConcavityOptions& options = {});

// Returns the boundary concavity Hb of X. Wei et al., "Approximate convex decomposition for 3D
// meshes with collision-aware concavity and tree search", 2022: the largest distance (m) from a
// point sampled on the hull's surface to the surface of `mesh`, or the reverse. Throws core::Error
// for invalid or empty meshes.
double HausdorffToHull(const core::TriangleMesh& mesh, const core::TriangleMesh& hull,
                       int samples = 3000, std::uint64_t seed = 1);

// Returns the full concavity (m) of the same paper: max(HausdorffToHull, 0.3 cbrt(3 (Vol(hull) -
// Vol(mesh)) / (4 pi))).
double Concavity(const core::TriangleMesh& mesh, const core::TriangleMesh& hull, int samples = 3000,
                 std::uint64_t seed = 1);

}  // namespace simwright::geometry
