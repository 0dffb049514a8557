#pragma once

#include "core/mesh.h"

namespace simwright::texture {

// The colour steps of a texture over a distance of two texels, RMS over the channels, in [0, 1].
struct SeamSteps {
  int seam_samples = 0;
  double seam_mean = 0.0, seam_p95 = 0.0;      // across the borders of charts
  double inside_mean = 0.0, inside_p95 = 0.0;  // beside them

  // Returns the mean step across borders over that inside, 0 without borders; a texture of one
  // colour has no step inside and counts at least one grey level.
  double Ratio() const;
};

// Measures the steps where two triangles meet at an edge of the surface but not of the atlas, from
// a texel before the edge to a texel behind it, and over the same distance beside the edge, from a
// texel to three away from it and along it; the direction with the larger mean step counts, since
// wood hardly changes along its grain. So far apart, no texel takes part in both bilinear lookups.
// Places where the triangles are too narrow are left out, and edges at which the surface turns by
// more than `largest_turn` (rad): a print may end there. Vertices at one place are one. The mesh
// has one texture, its first.
SeamSteps MeasureSeamSteps(const core::TexturedMesh& mesh, double largest_turn);

}  // namespace simwright::texture
