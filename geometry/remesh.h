#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct RemeshOptions {
  double edge_length = 0.0;         // target, metres, > 0
  int iterations = 3;               // 3: most edges within 4/5 .. 4/3 of the target
  double feature_angle_deg = 40.0;  // sharper edges are preserved
};

// Remeshes isotropically (Botsch and Kobbelt 2004) to the given edge length, and preserves sharp
// edges and borders. Requires a manifold mesh, open or closed; throws core::Error otherwise, or if
// the result would exceed 20 million faces.
core::TriangleMesh RemeshIsotropic(const core::TriangleMesh& mesh, const RemeshOptions& options);

}  // namespace simwright::geometry
