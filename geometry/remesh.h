#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct RemeshOptions {
  double edge_length = 0.0;         // target, metres, > 0
  int iterations = 3;               // 3: most edges within 4/5 .. 4/3 of the target
  double feature_angle_deg = 40.0;  // edges sharper than this stay where they are
};

// Isotropic remeshing (Botsch and Kobbelt 2004): even triangles of the given edge length, sharp
// edges and borders kept. Takes a manifold mesh, open or closed; throws core::Error otherwise, or
// where more than 20 million faces would come of it.
core::TriangleMesh RemeshIsotropic(const core::TriangleMesh& mesh, const RemeshOptions& options);

}  // namespace simwright::geometry
