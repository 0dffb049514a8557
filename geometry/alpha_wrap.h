#pragma once

#include "core/mesh.h"

namespace simwright::geometry {

struct AlphaWrapOptions {
  // Both are shares of the diagonal of the mesh's AABB.
  double alpha_ratio = 1.0 / 50.0;    // gaps narrower than this are closed
  double offset_ratio = 1.0 / 600.0;  // distance of the wrap outside the surface
};

// Returns CGAL's alpha wrap of the mesh (Portaneri et al. 2022), in the mesh's frame and units. The
// wrap is always closed, manifold and oriented outward. However, it lies strictly outside the input
// by the offset, and it closes narrow cavities; MakeSolid therefore uses it last. Throws
// core::Error for a mesh without faces or extent, for ratios that are not positive, and if CGAL
// fails.
core::TriangleMesh AlphaWrap(const core::TriangleMesh& mesh, const AlphaWrapOptions& options = {});

}  // namespace simwright::geometry
