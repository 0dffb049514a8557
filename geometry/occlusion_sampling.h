#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "geometry/surface_distance.h"

namespace simwright::geometry {

struct OcclusionSamplingOptions {
  double reach = 0.0;  // > 0, in the mesh's unit: only hits farther than this from the solid count
  int rays = 2000000;  // random chords in the initial search for such hits; >= 0
  int places = 60;     // largest number of hits to refine per generation; >= 0
  int rays_per_hit = 400;  // rays tried around each; >= 0
  int generations = 2;     // refinement rounds: new hits are refined again; >= 0
  double radius = 0.0;     // > 0: distance from the hit to the point of its line of sight through
                           // which new rays pass, in the mesh's unit
  std::uint64_t seed = 1;
};

// Samples first hits on `visual` from outside that lie farther than `reach` from `solid`. Random
// rays seldom enter a slit, so where some of them end farther than `reach` from `solid`, many more
// rays are sent through points of the same line of sight at small angles to it. The random hits
// come first in the result; `*random_count` (may be null) receives their number. Deterministic for
// a seed, whatever the thread count. Throws core::Error if one of the meshes has no faces or is
// invalid, a length is not positive or a number negative.
std::vector<OuterHit> SampleOccludedHits(const core::TriangleMesh& visual,
                                         const core::TriangleMesh& solid,
                                         const OcclusionSamplingOptions& options,
                                         int* random_count = nullptr);

}  // namespace simwright::geometry
