#pragma once

#include "core/mesh.h"

namespace simwright {

// Returns a latitude-longitude ball of radius 0.5 m with bumps: `rings` x 2 rings quads, two
// triangles each, open at the poles. bench/peers/forward_rays.py makes the same mesh.
core::TriangleMesh BumpyBall(int rings);

// Closes such a ball by a vertex at each pole: (0, 0, 0.5) and then (0, 0, -0.5).
void CloseAtPoles(core::TriangleMesh* ball);

}  // namespace simwright
