#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "geometry/surface_distance.h"

namespace simwright::geometry {

struct HiddenSightOptions {
  double reach = 0.0;   // > 0, in the mesh's unit: what is seen farther than this from the solid
  int rays = 2000000;   // random chords among which such sights are looked for; >= 0
  int places = 60;      // at most so many of them are looked into; >= 0
  int sights = 400;     // lines of sight tried at each; >= 0
  int generations = 2;  // of places: what is found is looked into again; >= 0
  double radius = 0.0;  // > 0: how far up a known line of sight others pass, in the mesh's unit
  std::uint64_t seed = 1;
};

// Random lines of sight seldom enter a slit. Where some are found to end farther than `reach` from
// `solid`, many more are sent through points of them, turned a little. Returned are all first hits
// on `visual` from outside that lie farther than `reach` from `solid`; the first ones returned are
// the random ones, of which `*random_count` (may be null) says how many there are.
// Deterministic for a seed, whatever the threads. Throws core::Error where one of the meshes has no
// faces or is not valid, a length is not positive or a number negative.
std::vector<OuterHit> HiddenSights(const core::TriangleMesh& visual,
                                   const core::TriangleMesh& solid,
                                   const HiddenSightOptions& options, int* random_count = nullptr);

}  // namespace simwright::geometry
