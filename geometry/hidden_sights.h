#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh.h"
#include "geometry/surface_distance.h"

namespace simwright::geometry {

struct HiddenSightOptions {
  double reach = 0.0;         // > 0, in the mesh's unit: what lies farther apart is looked into
  int rays = 80000;           // random lines of sight among which such places are looked for
  int solid_samples = 30000;  // points on the solid, likewise
  int places = 60;            // at most so many are looked into, of each kind
  int sights = 400;           // lines of sight tried at each place
  double radius = 0.0;        // > 0: of a place, in the mesh's unit
  std::uint64_t seed = 1;
};

// Random lines of sight seldom enter a slit. Where the outer surface of `visual` and `solid` lie
// farther apart than `reach`, many lines are sent through points of the one that found it (or
// through the solid's point, where that is what lies apart); returned are the first hits of those
// that come from outside and end within `radius` of the place. Deterministic for a seed.
// Throws core::Error where one of the meshes has no faces or is not valid, a length is not positive
// or a number negative.
std::vector<OuterHit> HiddenSights(const core::TriangleMesh& visual,
                                   const core::TriangleMesh& solid,
                                   const HiddenSightOptions& options);

}  // namespace simwright::geometry
